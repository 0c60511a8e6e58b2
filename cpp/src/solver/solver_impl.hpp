// SPDX-License-Identifier: BSD-3-Clause
// The pipeline, and the memory one solve needs.
#pragma once

#include <array>
#include <atomic>
#include <memory>

#include "iksel/solver.hpp"
#include "iteration/iterate.hpp"
#include "selection/selection.hpp"
#include "solver/lane_search.hpp"
#include "solver/task_search.hpp"

namespace iksel {

/// What one solve writes to. Never shared between two solves at once.
struct Workspace {
  Workspace(const ChainModel& model, const DatabaseData& data, const SolverOptions& options);

  Selection selection;
  TaskSearch tasks;
  /// Only if the options iterate by KDL, whose objects are not safe to share.
  std::unique_ptr<KdlChain> kdl;
  /// Only if the options solve in lanes.
  std::unique_ptr<LaneSearch> lanes;
};

struct Solver::Impl {
  Impl(const Robot& robot_in, const SolverOptions& options_in, const Database& database_in);
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  /// The whole pipeline for one valid target; `seed` and `times` may be null.
  Result solve(const Pose& T_base_tip, const JointVector* seed, Workspace& workspace,
               StageTimes* times) const;
  /// As above, for a task of its own.
  Result solve(const Pose& T_base_tip, const TaskSpace& task_of_call, const JointVector* seed,
               Workspace& workspace, StageTimes* times) const;

  /// A workspace of this solver, given back when it goes.
  class Lease {
   public:
    explicit Lease(const Impl& solver);
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    ~Lease();
    [[nodiscard]] Workspace& get() const { return *workspace_; }

   private:
    const Impl& solver_;
    Workspace* workspace_ = nullptr;
  };

  Robot robot;
  SolverOptions options;
  Database database;
  /// options.task.
  TaskSpace task;

 private:
  Result finish(Result result, const TaskSpace& task_of_call, const Pose& target,
                const JointVector& q) const;

  /// Workspaces that lie idle; a null is a place to put one back. More solves at once than places
  /// make their own.
  static constexpr std::size_t kPlaces = 64;
  mutable std::array<std::atomic<Workspace*>, kPlaces> idle_{};
};

}  // namespace iksel
