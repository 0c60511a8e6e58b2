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
#include "solver/tips_search.hpp"

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
  return data.reduction->left == expected.left && data.reduction->right == expected.right;
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
/// And where they may be refused, beside a fold one of two but not the other. Of 300 poses of a UR5
/// whose elbow is 2e-4 to 1e-3 from straight, with a filter that lets through one side, 40 had been
/// lost. Filters are asked about as many as with 2e-3, beside singularities up to 1.6 times as
/// many.
constexpr double kSameToScreen = 1e-4;

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
                   const std::optional<Database>& database_in, const Robot& nominal_in)
    : robot(robot_in),
      options(options_in),
      database(database_in),
      nominal(nominal_in),
      task(options.task, options.position_tolerance, options.rotation_tolerance),
      angles(robot, options),
      workspaces(robot, nominal, database ? &check_fits(nominal, *database) : nullptr, options) {
  if (!database) tips = std::make_unique<const TipsSearch>(*robot.several(), options);
}

Solver::Impl::~Impl() = default;

double Solver::Impl::rotation_weight() const {
  if (!tips) return database->data().weight;
  double most = 0;
  for (int i = 0; i < robot.tips(); ++i) {
    most = std::max(most, tips->chain(i).database().data().weight);
  }
  return most;
}

void Solver::Impl::check(const SolveRequest& request) const {
  request.validate(robot.dof(), robot.tips());
  if (request.scene) request.scene->check_fits(robot);
  angles.check(request);
}

void Solver::Impl::check_tips(std::size_t poses) const {
  if (poses == static_cast<std::size_t>(robot.tips())) return;
  throw InvalidArgumentError("poses: expected one for each of " + std::to_string(robot.tips()) +
                             " tips (" + list_names(robot.tip_links()) + "), got " +
                             std::to_string(poses));
}

std::size_t Solver::Impl::check_rows(std::size_t poses) const {
  const auto each = static_cast<std::size_t>(robot.tips());
  if (poses % each == 0) return poses / each;
  throw InvalidArgumentError("poses: expected " + std::to_string(each) +
                             " for each target, one for each tip, got " + std::to_string(poses));
}

std::vector<Pose> Solver::Impl::check_targets(const std::vector<Pose>& T_base_tip) const {
  check_tips(T_base_tip.size());
  std::vector<Pose> targets;
  for (std::size_t i = 0; i < T_base_tip.size(); ++i) {
    Pose nearest;
    targets.push_back(
        tips ? to_rigid(T_base_tip[i], nearest, "poses", static_cast<std::ptrdiff_t>(i))
             : to_rigid(T_base_tip[i], nearest));
  }
  return targets;
}

TaskSpace Solver::Impl::task_of(const TargetCriteria& criteria, int tip) const {
  const auto& [common, each, in_frame_of] = criteria;
  if (each.empty() && !common) return task;
  return {each.empty() ? *common : each[static_cast<std::size_t>(tip)], options.position_tolerance,
          options.rotation_tolerance};
}

std::vector<TaskSpace> Solver::Impl::tasks_of(const TargetCriteria& criteria) const {
  std::vector<TaskSpace> tasks;
  tasks.reserve(static_cast<std::size_t>(robot.tips()));
  for (int tip = 0; tip < robot.tips(); ++tip) tasks.push_back(task_of(criteria, tip));
  return tasks;
}

template <typename Answers>
Proof Solver::Impl::search_for(Answers& answers, Workspace& workspace, StageTimes* times) const {
  return tips ? tips->search_for(answers, workspace)
              : iksel::search_for(options, answers, workspace, times);
}

Result Solver::Impl::find_first(const Goal& goal, const SolveRequest& request, Workspace& workspace,
                                StageTimes* times, Effort effort) const {
  const bool wraps = tips != nullptr || workspace.scheme.whole_turns;
  FirstAnswer answers(wraps, goal, request, options.max_attempts, effort);
  Result result = answers.result(search_for(answers, workspace, times));
  const bool may_miss_arcs = effort == Effort::full && goal.is_full_pose() && !goal.scene() &&
                             request.database_seeds && workspace.lanes &&
                             workspace.lanes->has_unknown_arcs();
  const bool is_over =
      result.success() || result.proof != Proof::none || result.status == Status::out_of_time;
  if (is_over || !may_miss_arcs) return result;
  // Short arcs may be but where seeds come to rest, which takes more steps than what screens them
  // has: as solve_all, which then finds nothing where this does not.
  const auto has_any = [](const Collector& found) { return found.has_any(); };
  Collector search(goal, request, {kSame, /*until_complete=*/true}, has_any, options.max_attempts,
                   workspace.collected);
  collect(search, workspace, times);
  if (search.has_any()) goal.check(workspace.collected.found.at(0), result);
  result.iterations += search.result().iterations;
  return result;
}

void Solver::Impl::collect(Collector& collector, Workspace& workspace, StageTimes* times) const {
  collector.offer_near();
  collector.conclude(search_for(collector, workspace, times));
}

Result Solver::Impl::solve(const Pose* targets, const SolveRequest& request, Workspace& workspace,
                           StageTimes* times, double within) const {
  const Scene* scene = request.scene ? &*request.scene : nullptr;
  return with_goal(targets, request, scene, [&](const Goal& goal) {
    Result result = find_answer(goal, request, workspace, times, within);
    if (!result.success() && request.closest) {
      give_closest(options, goal, request, to_vector(*request.closest, rotation_weight()),
                   workspace, result);
    }
    if (result.success() && request.objective.is_set()) {
      result.cost = ObjectiveCost(robot.all(), request.objective).value(result.q);
    }
    return result;
  });
}

Result Solver::Impl::find_answer(const Goal& goal, const SolveRequest& request,
                                 Workspace& workspace, StageTimes* times, double within) const {
  if (!ranks_answers(request) && !request.filter) {
    Result first = find_first(goal, request, workspace, times);
    if (!request.exact || first.status != Status::in_collision) return first;
  }
  Result result;
  if (stays(goal, request, result)) return result;
  if (!request.exact && goal.is_never_free()) return find_first(goal, request, workspace, times);
  Screen screen(request, robot.dof());
  AnswerSelector selector(goal, request, workspace.collected.found, screen);
  const auto is_satisfied = [&](const Collector& so_far) { return selector.is_satisfied(so_far); };
  // With a screen the selector decides: nothing may have passed it yet.
  const bool is_screened = screen.is_set();
  const bool has_curve = goal.is_full_pose() && workspace.lanes && workspace.lanes->sweep;
  const Collector::Aim aim{is_screened ? kSameToScreen : kSame,
                           selector.wants_all() && !is_screened, has_curve ? selector.spread() : 0,
                           within};
  Collector search(goal, request, aim, is_satisfied, options.max_attempts, workspace.collected);
  collect(search, workspace, times);

  result = search.result();
  JointVector q;
  if (result.success() && !(selector.select(search, q) && goal.check(q, result))) {
    result.status = screen.refusal();
    if (selector.leaves_out()) result.proof = Proof::none;
  }
  if (!result.success()) {
    result.status = search.reason(result.status, result.proof);
  } else if (request.near) {
    result.move = JointMove(robot.dof(), request).length(q - *request.near);
  }
  result.iterations += selector.steps();
  return result;
}

Solver::Solver(const Robot& robot, const SolverOptions& options) {
  options.validate();
  std::optional<Database> database;
  if (robot.tips() == 1) database = Database::build(robot, options.database);
  impl_ = std::make_shared<const Impl>(robot, options, database, robot);
}

Solver::Solver(const Robot& robot, const SolverOptions& options, const Database& database) {
  options.validate();
  impl_ = std::make_shared<const Impl>(robot, options, database, robot);
}

const Robot& Solver::robot() const { return impl_->robot; }
const SolverOptions& Solver::options() const { return impl_->options; }
const Database& Solver::database() const { return impl_->data(); }

const Solver& Solver::chain_solver(int tip) const {
  static_cast<void>(robot().chain(tip));  // checks
  return impl_->tips ? impl_->tips->chain(tip) : *this;
}

std::size_t Solver::work_bound() const {
  return static_cast<std::size_t>(options().max_attempts) *
         static_cast<std::size_t>(options().max_iterations);
}

Result Solver::solve(const Pose& T_base_tip) const {
  if (impl_->tips) impl_->check_tips(1);
  Pose nearest;
  const Pose& target = to_rigid(T_base_tip, nearest);
  const WorkspacePool::Lease lease(impl_->workspaces);
  return impl_->find_first(Goal(impl_->model(), impl_->task, target), impl_->nothing, lease.get(),
                           nullptr);
}

Result Solver::solve(const Pose& T_base_tip, const SolveRequest& request, StageTimes* times) const {
  if (impl_->tips) impl_->check_tips(1);
  Pose nearest;
  const Pose& target = to_rigid(T_base_tip, nearest);
  impl_->check(request);
  const WorkspacePool::Lease lease(impl_->workspaces);
  return impl_->solve(&target, request, lease.get(), times);
}

Result Solver::solve(const std::vector<Pose>& T_base_tip, const SolveRequest& request,
                     StageTimes* times) const {
  const std::vector<Pose> targets = impl_->check_targets(T_base_tip);
  impl_->check(request);
  const WorkspacePool::Lease lease(impl_->workspaces);
  return impl_->solve(targets.data(), request, lease.get(), times);
}

}  // namespace iksel
