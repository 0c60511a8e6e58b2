// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/tree_solver.hpp"

#include <algorithm>

#include "base/message_text.hpp"
#include "base/pose_check.hpp"
#include "goal/angle_bound.hpp"
#include "iksel/error.hpp"
#include "search/search.hpp"
#include "seeds/given_seeds.hpp"
#include "seeds/nearby_seeds.hpp"
#include "seeds/seed_sequence.hpp"
#include "tree/stacked_refiner.hpp"
#include "tree/tree_answers.hpp"
#include "tree/tree_seeds.hpp"
#include "tree/tree_solver_impl.hpp"

namespace iksel {
namespace {

/// Seeds that one arm has behind each value of the shared joints, of which there are others.
constexpr int kArmAttempts = 64;

/// The move is of all joints of the tree.
SolveRequest move_of(const TreeRequest& request) {
  SolveRequest move;
  move.near = request.near;
  move.weights = request.weights;
  move.norm = request.norm;
  move.deadline = request.deadline;
  return move;
}

}  // namespace

void TreeRequest::validate(int dof, int tips) const {
  move_of(*this).validate(dof);
  if (!tasks.empty() && tasks.size() != static_cast<std::size_t>(tips)) {
    throw InvalidArgumentError("tasks: expected one for each of " + std::to_string(tips) +
                               " tips, or none, got " + std::to_string(tasks.size()));
  }
  for (const Task& task : tasks) task.validate();
}

TreeSolver::Impl::Impl(const TreeRobot& robot_in, const SolverOptions& options_in)
    : robot(robot_in), options(options_in) {
  SolverOptions of_arm = options;
  of_arm.max_attempts = std::min(options.max_attempts, kArmAttempts);
  for (const TreeTip& tip : model().tips) {
    TipSolvers& of_tip = solvers.emplace_back(TipSolvers{Solver(tip.chain.robot, options), {}});
    if (!tip.arm) continue;
    if (tip.stem) {
      of_tip.arm.emplace(tip.arm->robot, of_arm);
    } else {
      of_tip.arm = of_tip.chain;
    }
  }
}

void TreeSolver::Impl::check(const TreeRequest& request) const {
  request.validate(robot.dof(), robot.tips());
  if (request.near) check_near(*request.near);
}

void TreeSolver::Impl::check_near(const JointVector& near) const {
  check_joints(near, robot.dof(), "near");
  for (int i = 0; i < robot.tips(); ++i) {
    const TreePart& chain = model().tip(i).chain;
    AngleBound(chain.model(), options).check(picked(near, chain.joints), "near");
  }
}

std::vector<Pose> TreeSolver::Impl::check_targets(const std::vector<Pose>& T_base_tip) const {
  if (T_base_tip.size() != static_cast<std::size_t>(robot.tips())) {
    throw InvalidArgumentError("poses: expected one for each of " + std::to_string(robot.tips()) +
                               " tips (" + list_names(robot.tip_links()) + "), got " +
                               std::to_string(T_base_tip.size()));
  }
  std::vector<Pose> targets;
  for (std::size_t i = 0; i < T_base_tip.size(); ++i) {
    Pose nearest;
    targets.push_back(to_rigid(T_base_tip[i], nearest, "poses", static_cast<std::ptrdiff_t>(i)));
  }
  return targets;
}

std::vector<TaskSpace> TreeSolver::Impl::tasks_of(const TreeRequest& request) const {
  std::vector<TaskSpace> tasks;
  for (int i = 0; i < robot.tips(); ++i) {
    const Task& task =
        request.tasks.empty() ? options.task : request.tasks[static_cast<std::size_t>(i)];
    tasks.emplace_back(task, options.position_tolerance, options.rotation_tolerance);
  }
  return tasks;
}

TreeResult TreeSolver::Impl::solve(const std::vector<Pose>& targets,
                                   const TreeRequest& request) const {
  const std::vector<TaskSpace> tasks = tasks_of(request);
  const StackedGoal goal(model(), tasks, targets);
  TreeResult result;
  for (int i = 0; i < robot.tips(); ++i) {
    if (!goal.of(i).is_out_of_reach()) continue;
    result.status = Status::out_of_reach;
    result.proof = Proof::reach;
    result.unreachable_tip = i;
    return result;
  }
  Work work(options.max_attempts);
  ArmSearch arms(goal, solvers, request, options.seed);
  StackedRefiner refiner(goal, options.max_iterations);
  if (request.near) {
    find_nearest(goal, request, arms, refiner, work, result);
  } else {
    FirstTreeAnswer answers(goal, request, result);
    ArmSeeds behind_shared(goal, arms, nullptr, work);
    StackedSeeds stacked(goal, arms, options.seed, work, result);
    SeedSequence seeds(2, behind_shared, stacked);
    search(refiner, seeds, answers, work);
  }
  result.attempts = work.attempts;
  result.iterations = work.iterations;
  return result;
}

void TreeSolver::Impl::find_nearest(const StackedGoal& goal, const TreeRequest& request,
                                    ArmSearch& arms, StackedRefiner& refiner, Work& work,
                                    TreeResult& result) const {
  const JointMove move(robot.dof(), move_of(request));
  NearBound bound{*request.near, move};
  NearestTreeAnswer answers(goal, request, move, bound.best, work, result);
  NearSeed from_near(&bound.near, work);
  ArmSeeds behind_shared(goal, arms, &bound, work);
  SeedSequence near_seeds(2, from_near, behind_shared);
  if (search(refiner, near_seeds, answers, work)) return;
  if (!result.success()) {
    StackedSeeds stacked(goal, arms, options.seed, work, result);
    FirstTreeAnswer first(goal, request, result);
    search(refiner, stacked, first, work);
    if (!result.success()) return;
    JointVector q = result.q;
    answers.offer(0, q);
  }
  if (arms.has_all_arms()) return;
  // No values of the shared joints were tried: other answers are nearer at times.
  NearbySeeds nearby(model().joints, bound.near, options.seed, work);
  search(refiner, nearby, answers, work);
}

TreeSolver::TreeSolver(const TreeRobot& robot, const SolverOptions& options) {
  options.validate();
  impl_ = std::make_shared<Impl>(robot, options);
}

const TreeRobot& TreeSolver::robot() const { return impl_->robot; }
const SolverOptions& TreeSolver::options() const { return impl_->options; }

const Solver& TreeSolver::chain_solver(int tip) const {
  static_cast<void>(impl_->robot.chain(tip));  // checks
  return impl_->solvers[static_cast<std::size_t>(tip)].chain;
}

TreeResult TreeSolver::solve(const std::vector<Pose>& T_base_tip,
                             const TreeRequest& request) const {
  const std::vector<Pose> targets = impl_->check_targets(T_base_tip);
  impl_->check(request);
  return impl_->solve(targets, request);
}

}  // namespace iksel
