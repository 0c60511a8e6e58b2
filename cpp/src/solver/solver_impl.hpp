// SPDX-License-Identifier: BSD-3-Clause
// The pipeline, and the memory one solve needs.
#pragma once

#include <array>
#include <atomic>
#include <bitset>
#include <memory>

#include "iksel/solver.hpp"
#include "iteration/iterate.hpp"
#include "selection/selection.hpp"
#include "solver/explore.hpp"
#include "solver/found.hpp"
#include "solver/given_seeds.hpp"
#include "solver/lane_search.hpp"
#include "solver/task_search.hpp"

namespace iksel {

/// What one solve writes to. Never shared between two solves at once.
struct Workspace {
  /// `nominal` is the chain that the data belongs to.
  Workspace(const ChainModel& model, const ChainModel& nominal, const DatabaseData& data,
            const SolverOptions& options);

  Selection selection;
  TaskSearch tasks;
  /// Only if the options iterate by KDL, whose objects are not safe to share.
  std::unique_ptr<KdlChain> kdl;
  /// Only if the options solve in lanes.
  std::unique_ptr<LaneSearch> lanes;
  /// Of solves with wishes.
  GivenSeeds given;
  Found found;
  /// Guesses at solutions that a found one told of, still to be tried (mirror.hpp).
  std::vector<JointVector> mirrors;
  /// Room for that many; there are fewer solutions that come in pairs.
  static constexpr std::size_t kMirrors = 64;
};

struct Solver::Impl {
  /// The nominal robot is the one that the database was built for.
  Impl(const Robot& robot_in, const SolverOptions& options_in, const Database& database_in,
       const Robot& nominal_in);
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  /// The whole pipeline for one valid target; `seed` and `times` may be null.
  Result solve(const Pose& T_base_tip, const JointVector* seed, Workspace& workspace,
               StageTimes* times) const;

  /// Targets first to last - 1, whose poses `target(i)` gives: `settle(i, result)` for each, in any
  /// order. What comes out for one does not depend on the others.
  template <typename Target, typename Settle>
  void solve_many(std::size_t first, std::size_t last, Workspace& workspace, const Target& target,
                  const Settle& settle) const;

  /// As solve_many, with wishes; `request` is changed in its `near` only, to near(i) if that is not
  /// null.
  template <typename Target, typename Near, typename Settle>
  void solve_many(std::size_t first, std::size_t last, SolveRequest& request, Workspace& workspace,
                  const Target& target, const Near& near, const Settle& settle) const;

  /// Targets 0 to count - 1 with wishes by `threads` threads.
  template <typename Target, typename Near, typename Settle, typename OnProgress>
  void solve_batch(std::size_t count, const SolveRequest& request, int threads,
                   const Target& target, const Near& near, const Settle& settle,
                   const OnProgress& on_progress) const;

  /// A whole batch: `settle_row(row, result)` for each row of `pose_at`, in any order and from any
  /// thread; near_of(row) may be null.
  template <typename PoseAt, typename Near, typename Settle>
  void solve_rows(std::size_t count, const PoseAt& pose_at, const SolveRequest& request,
                  const Near& near_of, int threads, const Settle& settle_row,
                  const Progress& progress) const;

  /// The whole pipeline for one valid target with wishes.
  Result solve(const Pose& T_base_tip, const SolveRequest& request, Workspace& workspace) const;
  Solutions solve_all(const Pose& T_base_tip, const SolveAllOptions& all,
                      const SolveRequest& request, Workspace& workspace) const;

  Diagnosis diagnose(const Pose& T_base_tip, const SolveRequest& request) const;

  /// Throws InvalidArgumentError unless the request fits the chain.
  void check(const SolveRequest& request) const;
  /// The first joint beyond `largest_angle`, or -1.
  [[nodiscard]] int first_large_angle(const JointVector& q) const;
  /// Throws InvalidArgumentError naming the first joint beyond `largest_angle`.
  void check_angles(const JointVector& q, const char* name) const;

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
  Robot nominal;
  Drift drift;
  /// options.task.
  TaskSpace task;
  /// As Block::damaged of the database.
  const std::atomic<bool>* damaged;
  int most_solutions = 0;
  /// Angles up to this lose a tenth of the tolerances at most when FK rounds them [rad].
  double largest_angle;

  /// Most targets of one solve_many.
  static constexpr std::size_t kMany = 256;

  PathResult solve_path(const std::vector<Pose>& T_base_tip, const PathOptions& path,
                        Workspace& workspace) const;
  /// Nothing is a success by hearsay: measures q itself, and only if that reaches the target inside
  /// the limits, makes it the result.
  bool finish(const TaskSpace& of_call, const Pose& target, const JointVector& q,
              Result& result) const;

 private:
  [[nodiscard]] double find_largest_angle() const;
  void check_limits() const;
  [[nodiscard]] bool out_of_reach(const TaskSpace& of_call, const Pose& T_base_tip) const;
  /// The task of a request, or the options'.
  [[nodiscard]] TaskSpace task_of(const SolveRequest& request) const;
  class Judge;
  /// The most solutions that one of some poses has, if the signs of det J tell when a search has
  /// them all; else 0.
  [[nodiscard]] int count_most_solutions() const;
  class Inquiry;
  /// Makes q the best effort of a diagnosis.
  void describe(const TaskSpace& of_call, const Pose& target, const JointVector& q,
                Diagnosis& out) const;
  /// Collects solutions in workspace.found.
  void explore(Exploration& search, Workspace& workspace) const;
  /// Brings a success to the turns nearest to `near`, where it still is one.
  void take_turns_near(const JointVector& near, const TaskSpace& of_call, const Pose& T_base_tip,
                       Result& answer) const;
  void explore_in_lanes(Exploration& search, Workspace& workspace,
                        FunctionRef<Verdict(JointVector&)> accept, FunctionRef<bool()> go_on) const;
  void explore_one_by_one(Exploration& search, Workspace& workspace,
                          FunctionRef<Verdict(JointVector&)> accept,
                          FunctionRef<bool()> go_on) const;
  void explore_task(Exploration& search, Workspace& workspace,
                    FunctionRef<Verdict(JointVector&)> accept, FunctionRef<bool()> go_on) const;
  /// The errors of q: position [m] and rotation [rad]; and for a whole pose its Jacobian, if that
  /// is not null.
  void measure(const TaskSpace& of_call, const Pose& target, const JointVector& q, double& position,
               double& rotation, Jacobian* jacobian = nullptr) const;
  [[nodiscard]] bool within_tolerances(double position, double rotation) const;

  /// Workspaces that lie idle; a null is a place to put one back. More solves at once than places
  /// make their own.
  static constexpr std::size_t kPlaces = 64;
  mutable std::array<std::atomic<Workspace*>, kPlaces> idle_{};
};

template <typename Target, typename Settle>
void Solver::Impl::solve_many(std::size_t first, std::size_t last, Workspace& workspace,
                              const Target& target, const Settle& settle) const {
  if (workspace.lanes == nullptr || !task.is_full_pose()) {
    for (std::size_t i = first; i < last; ++i) {
      settle(i, solve(target(i), nullptr, workspace, nullptr));
    }
    return;
  }
  // Those that their best seeds do not solve are solved one by one afterwards.
  std::bitset<kMany> open;
  std::size_t at = first;
  const auto next = [&]() -> int {
    for (; at < last; ++at) {
      if (!out_of_reach(task, target(at))) return static_cast<int>(at++ - first);
      open.set(at - first);
    }
    return -1;
  };
  const auto target_at = [&](int offset) -> decltype(auto) {
    return target(first + static_cast<std::size_t>(offset));
  };
  workspace.lanes->stream(next, target_at, [&](int offset, JointVector* q, const Work& work) {
    const auto index = static_cast<std::size_t>(offset);
    if (q == nullptr) {
      open.set(index);
      return true;
    }
    robot.model().wrap_into_limits(q->data());
    Result result;
    result.attempts = work.attempts;
    result.iterations = work.iterations;
    if (!finish(task, target(first + index), *q, result)) return false;
    settle(first + index, result);
    return true;
  });
  for (std::size_t i = first; i < last; ++i) {
    if (open[i - first]) settle(i, solve(target(i), nullptr, workspace, nullptr));
  }
}

}  // namespace iksel
