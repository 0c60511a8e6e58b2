// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/solver.hpp"

#include <algorithm>
#include <cstdio>

#include "base/message_text.hpp"
#include "base/pose_check.hpp"
#include "goal/objective_cost.hpp"
#include "iksel/error.hpp"
#include "search/answer_selector.hpp"
#include "search/closest.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {
namespace {

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

/// Whether the database leaves out what the chain lets it leave out.
bool reduction_fits(const ChainModel& model, const DatabaseData& data) {
  if (!data.reduction) return true;
  const Reduction expected = Reduction::of(model, data.weight);
  return is_simple(model) && data.reduction->left() == expected.left() &&
         data.reduction->right() == expected.right();
}

/// The database, if it is fit for the robot.
const Database& check_fits(const Robot& robot, const Database& database) {
  database.data().check_intact();
  if (database.chain_hash() == robot.chain_hash() && database.dof() == robot.dof() &&
      reduction_fits(robot.model(), database.data())) {
    return database;
  }
  throw DatabaseMismatchError(
      "the database (" + std::to_string(database.dof()) + " joints, chain hash " +
      hex(database.chain_hash()) + ") was built for another chain than robot '" + robot.name() +
      "' (" + std::to_string(robot.dof()) + " joints, chain hash " + hex(robot.chain_hash()) + ")");
}

/// Solutions nearer than this in every joint are looked at once [rad or m]: how far apart answers
/// of one branch may lie at the default tolerances where the arm is singular.
constexpr double kSame = 2e-3;

/// Whether the arm stands at the goal already, where no move is the smallest, and nothing can
/// refuse that; `near` is then the result.
bool stays(const Goal& goal, const SolveRequest& request, Result& result) {
  if (!request.near || request.objective.is_set() || request.exact || request.filter) return false;
  if (!goal.check(*request.near, result)) return false;
  if (!goal.is_free(*request.near)) {
    result = {};
    return false;
  }
  result.move = 0;
  return true;
}

}  // namespace

Solver::Impl::Impl(const Robot& robot_in, const SolverOptions& options_in,
                   const Database& database_in, const Robot& nominal_in)
    : robot(robot_in),
      options(options_in),
      database(check_fits(nominal_in, database_in)),
      nominal(nominal_in),
      task(options.task, options.position_tolerance, options.rotation_tolerance),
      angles(model(), options),
      workspaces(robot, nominal, database, options) {}

void Solver::Impl::check(const SolveRequest& request) const {
  request.validate(robot.dof());
  if (request.scene) request.scene->check_fits(robot);
  angles.check(request);
}

TaskSpace Solver::Impl::task_of(const SolveRequest& request) const {
  if (!request.task) return task;
  return {*request.task, options.position_tolerance, options.rotation_tolerance};
}

Result Solver::Impl::find_first(const Pose& target, const TaskSpace& of_call,
                                const SolveRequest& request, Workspace& workspace,
                                StageTimes* times) const {
  const Goal goal(model(), of_call, target, request.scene ? &*request.scene : nullptr);
  return iksel::find_first(model(), options, goal, request, workspace, times);
}

Result Solver::Impl::solve(const Pose& target, const SolveRequest& request, Workspace& workspace,
                           StageTimes* times) const {
  const TaskSpace of_call = task_of(request);
  Result result = find_answer(target, of_call, request, workspace, times);
  if (result.success() || !request.closest) return result;
  const Goal goal(model(), of_call, target);
  give_closest(model(), options, goal, request, to_vector(*request.closest, database.data()),
               workspace, result);
  return result;
}

Result Solver::Impl::find_answer(const Pose& target, const TaskSpace& of_call,
                                 const SolveRequest& request, Workspace& workspace,
                                 StageTimes* times) const {
  if (!ranks_answers(request) && !request.filter) {
    Result first = find_first(target, of_call, request, workspace, times);
    if (!request.exact || first.status != Status::in_collision) return first;
  }
  const Goal goal(model(), of_call, target, request.scene ? &*request.scene : nullptr);
  Result result;
  if (stays(goal, request, result)) return result;
  if (!request.exact && goal.is_never_free())
    return find_first(target, of_call, request, workspace, times);
  Screen screen(request.scene, request.exact, request.filter, robot.dof());
  AnswerSelector selector(model(), goal, request, workspace.collected.found, screen);
  const auto is_satisfied = [&](const Collector& so_far) { return selector.is_satisfied(so_far); };
  // With a screen the selector decides: nothing may have passed it yet.
  const Collector::Aim aim{kSame, selector.wants_all() && !screen.is_set()};
  Collector search(model(), goal, request, aim, is_satisfied, options.max_attempts,
                   workspace.collected);
  collect(model(), options, search, workspace, times);

  result = search.result();
  JointVector q;
  if (result.success() && !(selector.select(search, q) && goal.check(q, result))) {
    result.status = screen.refusal();
  }
  if (result.success()) {
    if (request.objective.is_set()) {
      result.cost = ObjectiveCost(model(), request.objective).value(q);
    }
    if (request.near) result.move = JointMove(robot.dof(), request).length(q - *request.near);
  } else if (search.is_out_of_time()) {
    result.status = Status::out_of_time;
  }
  result.iterations += selector.steps();
  return result;
}

Solver::Solver(const Robot& robot, const SolverOptions& options) {
  options.validate();
  impl_ = std::make_shared<Impl>(robot, options, Database::build(robot, options.database), robot);
}

Solver::Solver(const Robot& robot, const SolverOptions& options, const Database& database) {
  options.validate();
  impl_ = std::make_shared<Impl>(robot, options, database, robot);
}

const Robot& Solver::robot() const { return impl_->robot; }
const SolverOptions& Solver::options() const { return impl_->options; }
const Database& Solver::database() const { return impl_->database; }

std::size_t Solver::work_bound() const {
  return static_cast<std::size_t>(options().max_attempts) *
         static_cast<std::size_t>(options().max_iterations);
}

Result Solver::solve(const Pose& T_base_tip) const {
  Pose nearest;
  const Pose& target = to_rigid(T_base_tip, nearest);
  const WorkspacePool::Lease lease(impl_->workspaces);
  return impl_->find_first(target, impl_->task, impl_->nothing, lease.get(), nullptr);
}

Result Solver::solve(const Pose& T_base_tip, const SolveRequest& request, StageTimes* times) const {
  Pose nearest;
  const Pose& target = to_rigid(T_base_tip, nearest);
  impl_->check(request);
  const WorkspacePool::Lease lease(impl_->workspaces);
  return impl_->solve(target, request, lease.get(), times);
}

}  // namespace iksel
