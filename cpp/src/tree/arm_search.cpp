// SPDX-License-Identifier: BSD-3-Clause
#include "tree/arm_search.hpp"

#include "base/rotation.hpp"

namespace iksel {
namespace {

/// What is asked of the joints of one part of the tree.
SolveRequest request_for(const TreePart& part, const TreeRequest& request) {
  SolveRequest out;
  out.norm = request.norm;
  if (!request.near) return out;
  out.near = picked(*request.near, part.joints);
  if (request.weights.size() == 0) return out;
  const JointVector weights = picked(request.weights, part.joints);
  if (weights.maxCoeff() > 0) out.weights = weights;
  return out;
}

}  // namespace

ArmSearch::ArmSearch(const StackedGoal& goal, const std::vector<TipSolvers>& solvers,
                     const TreeRequest& request, std::uint64_t seed)
    : goal_(goal), solvers_(solvers), random_(seed) {
  for (int i = 0; i < goal.model().tip_count(); ++i) {
    const TreeTip& tip = goal.model().tip(i);
    const Task& task = goal.task(i).task();
    const bool draws = tip.stem && task.frame == TaskFrame::base && !task.is_full_pose();
    draws_pose_.push_back(draws);
    SolveRequest of_arm = tip.arm ? request_for(*tip.arm, request) : SolveRequest{};
    of_arm.task = draws ? Task::pose() : task;
    of_arm_.push_back(of_arm);
  }
}

bool ArmSearch::has_arm(int tip) const {
  const auto& arm = goal_.model().tip(tip).arm;
  const int fixed = draws_pose_[static_cast<std::size_t>(tip)] ? 6 : goal_.task(tip).fixed_axes();
  return arm && arm->robot.dof() >= fixed;
}

bool ArmSearch::has_all_arms() const {
  for (int i = 0; i < goal_.model().tip_count(); ++i) {
    if (!has_arm(i)) return false;
  }
  return true;
}

Pose ArmSearch::target_of_arm(int tip, const JointVector& q) {
  const Pose target = draws_pose_[static_cast<std::size_t>(tip)]
                          ? goal_.of(tip).random_pose(random_)
                          : goal_.target(tip);
  const auto& stem = goal_.model().tip(tip).stem;
  return stem ? compose(stem->fk(q).inverse(), target) : target;
}

bool ArmSearch::solve_arm(int tip, JointVector& q) {
  const auto i = static_cast<std::size_t>(tip);
  const Result result = solvers_[i].arm->solve(target_of_arm(tip, q), of_arm_[i]);
  if (result.success()) put(result.q, goal_.model().tip(tip).arm->joints, q);
  return result.success();
}

void ArmSearch::bring_closest(int tip, JointVector& q) {
  const auto i = static_cast<std::size_t>(tip);
  if (!solvers_[i].arm) return;
  of_arm_[i].closest.emplace();
  const Result result = solvers_[i].arm->solve(target_of_arm(tip, q), of_arm_[i]);
  of_arm_[i].closest.reset();
  if (has_joints(result.status)) put(result.q, goal_.model().tip(tip).arm->joints, q);
}

Result ArmSearch::solve_chain(int tip, bool from_here, JointVector& q) {
  const auto i = static_cast<std::size_t>(tip);
  const TreePart& chain = goal_.model().tip(tip).chain;
  SolveRequest request;
  request.task = goal_.task(tip).task();
  if (from_here) request.seeds.push_back(picked(q, chain.joints));
  Result result = solvers_[i].chain.solve(goal_.target(tip), request);
  if (result.success()) {
    put(result.q, chain.joints, q);
    q = goal_.model().joints.clamp(q);
  }
  return result;
}

}  // namespace iksel
