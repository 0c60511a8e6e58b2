// SPDX-License-Identifier: BSD-3-Clause
// What a Solver holds, and its calls for valid input.
#pragma once

#include "goal/angle_bound.hpp"
#include "iksel/solver.hpp"
#include "search/context.hpp"
#include "search/run.hpp"

namespace iksel {

struct Solver::Impl {
  /// The nominal robot is the one that the database was built for.
  Impl(const Robot& robot_in, const SolverOptions& options_in, const Database& database_in,
       const Robot& nominal_in);

  [[nodiscard]] const ChainModel& model() const { return robot.model(); }
  /// Throws InvalidArgumentError unless the request fits the chain.
  void check(const SolveRequest& request) const;
  /// The task of a request, or the options'.
  [[nodiscard]] TaskSpace task_of(const SolveRequest& request) const;

  /// The first answer that there is: of a request its seeds, `near` and deadline are read.
  Result find_first(const Pose& target, const TaskSpace& of_call, const SolveRequest& request,
                    Workspace& workspace, StageTimes* times) const;
  /// The best answer to the whole request, but for `closest`.
  Result find_answer(const Pose& target, const TaskSpace& of_call, const SolveRequest& request,
                     Workspace& workspace, StageTimes* times) const;
  /// The same, or what is closest.
  Result solve(const Pose& target, const SolveRequest& request, Workspace& workspace,
               StageTimes* times) const;
  Solutions solve_all(const Pose& target, const SolveAllOptions& all, const SolveRequest& request,
                      Workspace& workspace) const;
  PathResult solve_path(const std::vector<Pose>& targets, const PathOptions& path,
                        Workspace& workspace) const;
  /// Throws InvalidArgumentError unless there is a self-motion to be asked for.
  void check_self_motion(double spacing) const;
  [[nodiscard]] SelfMotion self_motion(const Pose& target, double spacing,
                                       Workspace& workspace) const;
  /// A batch: `on_row(row, result)` for each row of `pose_at`, in any order and from any thread;
  /// near_of(row) may be null.
  template <typename PoseAt, typename Near, typename OnRow>
  void solve_rows(std::size_t count, const PoseAt& pose_at, const SolveRequest& request,
                  const Near& near_of, int threads, const OnRow& on_row,
                  const Progress& progress) const;
  [[nodiscard]] Diagnosis diagnose(const Pose& target, const SolveRequest& request) const;

  Robot robot;
  SolverOptions options;
  Database database;
  Robot nominal;
  CalibrationDeviation deviation;
  TaskSpace task;
  AngleBound angles;
  WorkspacePool workspaces;
  /// A request for nothing.
  SolveRequest nothing;
};

}  // namespace iksel
