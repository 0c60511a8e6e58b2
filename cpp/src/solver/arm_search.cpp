// SPDX-License-Identifier: BSD-3-Clause
#include "solver/arm_search.hpp"

#include "base/rotation.hpp"
#include "goal/joint_move.hpp"
#include "solver/solver_impl.hpp"
#include "solver/tips_search.hpp"

namespace iksel {
namespace {

/// What is asked of the joints of one part of the robot.
SolveRequest request_for(const ChainPart& part, const std::optional<NearestTo>& nearest_to) {
  SolveRequest out;
  if (!nearest_to) return out;
  out.norm = nearest_to->move.norm();
  out.near = picked(nearest_to->from, part.joints);
  const JointVector weights = picked(nearest_to->move.weights(), part.joints);
  if (weights.maxCoeff() > 0) out.weights = weights;
  return out;
}

}  // namespace

ArmSearch::ArmSearch(const TipsGoal& goal, const std::vector<TipSolvers>& solvers,
                     const SolveRequest& request, std::uint64_t seed)
    : goal_(goal),
      solvers_(solvers),
      random_(seed),
      may_collide_(static_cast<bool>(request.exact)) {
  const std::optional<NearestTo> nearest_to = find_nearest_to(goal.model().dof, request);
  for (int i = 0; i < goal.count(); ++i) {
    const Tip& tip = goal.model().tip(i);
    const Task& task = goal.task(i).task();
    const bool draws = tip.stem && is_along_frame(i) && goal.frame_of(i) < 0;
    draws_pose_.push_back(draws);
    SolveRequest of_arm = tip.arm ? request_for(*tip.arm, nearest_to) : SolveRequest{};
    of_arm.task = draws ? Task::pose() : task;
    of_arm_.push_back(of_arm);
  }
}

bool ArmSearch::is_along_frame(int tip) const {
  const Task& task = goal_.task(tip).task();
  return task.frame == TaskFrame::base && !task.is_full_pose();
}

bool ArmSearch::has_arm(int tip) const {
  const auto& arm = goal_.model().tip(tip).arm;
  // Another tip's axes are none of the arm's base.
  if (goal_.frame_of(tip) >= 0 && is_along_frame(tip)) return false;
  const int fixed = draws_pose_[static_cast<std::size_t>(tip)] ? 6 : goal_.task(tip).fixed_axes();
  return arm && arm->robot.dof() >= fixed;
}

bool ArmSearch::has_all_arms() const {
  for (int i = 0; i < goal_.count(); ++i) {
    if (!has_arm(i)) return false;
  }
  return true;
}

bool ArmSearch::knows_nearest() const {
  for (int i = 0; i < goal_.count(); ++i) {
    const StructureKind kind = solvers_[static_cast<std::size_t>(i)].of_arm;
    if (!has_arm(i) || !goal_.stands_still(i) || kind == StructureKind::searched ||
        !goal_.task(i).task().is_full_pose()) {
      return false;
    }
  }
  return true;
}

Pose ArmSearch::target_of_arm(int tip, const JointVector& q) {
  const Tip& of_tip = goal_.model().tip(tip);
  const Pose target =
      draws_pose_[static_cast<std::size_t>(tip)]
          ? Goal(of_tip.chain.model(), goal_.task(tip), goal_.target(tip)).random_pose(random_)
          : goal_.target_at(tip, q);
  return of_tip.stem ? compose(of_tip.stem->fk(q).inverse(), target) : target;
}

Result ArmSearch::solve(const Solver& solver, const ChainPart& part, const Pose& target,
                        const SolveRequest& request, Effort effort, double within, JointVector& q) {
  const Solver::Impl& of = *solver.impl_;
  const WorkspacePool::Lease lease(of.workspaces);
  const auto solve_quickly = [&] {
    const TaskSpace task = of.task_of(request);
    return of.find_first(Goal(of.model(), task, target), request, lease.get(), nullptr, effort);
  };
  Result result = effort == Effort::quick
                      ? solve_quickly()
                      : of.solve(&target, request, lease.get(), nullptr, within);
  if (has_joints(result.status)) put(result.q, part.joints, q);
  return result;
}

bool ArmSearch::solve_arm(int tip, Effort effort, double within, JointVector& q) {
  const auto i = static_cast<std::size_t>(tip);
  // Without weights in the request, its joints have none in the move that is bounded.
  if (of_arm_[i].weights.size() == 0) within = kInfinity;
  SolveRequest bare;
  bare.task = of_arm_[i].task;
  return solve(*solvers_[i].arm, *goal_.model().tip(tip).arm, target_of_arm(tip, q),
               effort == Effort::quick ? bare : of_arm_[i], effort, within, q)
      .success();
}

std::vector<JointVector> ArmSearch::solve_arm(int tip, const JointVector& q, int most) {
  const auto i = static_cast<std::size_t>(tip);
  SolveAllOptions all;
  all.max = most;
  // Apart from each other, so that few are many places.
  all.min_distance = 0.1;
  const Solutions solutions = solvers_[i].arm->solve_all(target_of_arm(tip, q), all, of_arm_[i]);
  std::vector<JointVector> found;
  for (const Result& each : solutions.all) found.push_back(each.q);
  return found;
}

void ArmSearch::bring_closest(int tip, JointVector& q) {
  const auto i = static_cast<std::size_t>(tip);
  if (!solvers_[i].arm) return;
  SolveRequest request = of_arm_[i];
  request.closest.emplace();
  solve(*solvers_[i].arm, *goal_.model().tip(tip).arm, target_of_arm(tip, q), request, Effort::full,
        kInfinity, q);
}

Result ArmSearch::solve_chain(int tip, Effort effort, bool from_here, JointVector& q) {
  const ChainPart& chain = goal_.model().tip(tip).chain;
  SolveRequest request;
  request.task = goal_.task(tip).task();
  if (from_here) request.seeds.push_back(picked(q, chain.joints));
  Result result = solve(solvers_[static_cast<std::size_t>(tip)].chain, chain,
                        goal_.target_at(tip, q), request, effort, kInfinity, q);
  if (result.success()) q = goal_.model().joints.clamp(q);
  return result;
}

}  // namespace iksel
