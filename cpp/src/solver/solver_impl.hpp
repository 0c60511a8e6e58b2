// SPDX-License-Identifier: BSD-3-Clause
// What a Solver holds, and its calls for valid input.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "goal/angle_bound.hpp"
#include "iksel/solver.hpp"
#include "search/context.hpp"
#include "search/run.hpp"

namespace iksel {

class TipsSearch;

struct Solver::Impl {
  /// The nominal robot is the one that the database was built for; none: of several tips.
  Impl(const Robot& robot_in, const SolverOptions& options_in,
       const std::optional<Database>& database_in, const Robot& nominal_in);
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  /// The chain of the one tip. Throws InvalidArgumentError if there are several.
  [[nodiscard]] const ChainModel& model() const { return robot.model(); }
  [[nodiscard]] const Database& data() const {
    static_cast<void>(model());
    return *database;
  }
  /// What a rotation weighs where nothing else is said [m].
  [[nodiscard]] double rotation_weight() const;
  /// Throws InvalidArgumentError unless the request fits the robot.
  void check(const SolveRequest& request) const;
  /// Throws InvalidArgumentError unless there are poses for so many tips.
  void check_tips(std::size_t poses) const;
  /// How many targets that many poses are. Throws InvalidArgumentError unless each has one for each
  /// tip.
  std::size_t check_rows(std::size_t poses) const;
  /// The nearest rigid poses. Throws InvalidArgumentError unless there is one for each tip.
  [[nodiscard]] std::vector<Pose> check_targets(const std::vector<Pose>& T_base_tip) const;
  /// The task of a tip, or of each: that of the call, or the options'.
  [[nodiscard]] TaskSpace task_of(const TargetCriteria& criteria, int tip = 0) const;
  [[nodiscard]] std::vector<TaskSpace> tasks_of(const TargetCriteria& criteria) const;

  /// Calls `use` with the goal of those targets, one for each tip; `scene` may be null.
  template <typename Use>
  auto with_goal(const Pose* targets, const TargetCriteria& criteria, const Scene* scene,
                 const Use& use) const {
    if (const TipsModel* several = robot.several()) {
      const TipsGoal all(*several, tasks_of(criteria), {targets, targets + robot.tips()},
                         criteria.in_frame_of);
      return use(Goal(all, scene));
    }
    const TaskSpace of_call = task_of(criteria);
    return use(Goal(model(), of_call, *targets, scene));
  }

  /// The first answer that there is: of a request its seeds, `near` and deadline are read.
  Result find_first(const Goal& goal, const SolveRequest& request, Workspace& workspace,
                    StageTimes* times, Effort effort = Effort::full) const;
  /// Collects solutions in workspace.collected.found, until the collector has enough.
  void collect(Collector& collector, Workspace& workspace, StageTimes* times = nullptr) const;
  /// As in search/run.hpp, of any number of tips.
  template <typename Answers>
  Proof search_for(Answers& answers, Workspace& workspace, StageTimes* times) const;
  /// The best answer to the whole request, but for `closest`. Where that is the nearest, none that
  /// is farther than `within` need be found.
  Result find_answer(const Goal& goal, const SolveRequest& request, Workspace& workspace,
                     StageTimes* times, double within = kInfinity) const;
  /// The same, or what is closest. A target for each tip, as in the other calls.
  Result solve(const Pose* targets, const SolveRequest& request, Workspace& workspace,
               StageTimes* times, double within = kInfinity) const;
  Solutions solve_all(const Goal& goal, const SolveAllOptions& all, const SolveRequest& request,
                      Workspace& workspace) const;
  /// The same, chosen from as many solutions as `choice` of them would be.
  Solutions find_all(const Goal& goal, const SolveAllOptions& all, const SolveRequest& request,
                     std::size_t choice, Workspace& workspace) const;
  [[nodiscard]] Diagnosis diagnose(const Pose& target, const SolveRequest& request) const;
  [[nodiscard]] Diagnosis diagnose_tips(const std::vector<Pose>& targets,
                                        const SolveRequest& request) const;

  Robot robot;
  SolverOptions options;
  std::optional<Database> database;  ///< none: of several tips
  Robot nominal;
  CalibrationDeviation deviation;
  TaskSpace task;
  AngleBound angles;
  WorkspacePool workspaces;
  std::unique_ptr<const TipsSearch> tips;  ///< null: of one tip
  /// A request for nothing.
  SolveRequest nothing;
};

}  // namespace iksel
