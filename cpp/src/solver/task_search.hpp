// SPDX-License-Identifier: BSD-3-Clause
// The pipeline for a task that leaves something of the pose open: seeds for some of the poses that
// the task allows, the one nearest to the task first, between them configurations at random.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "database/data.hpp"
#include "iteration/iterate.hpp"
#include "selection/selection.hpp"
#include "solver/stage_clock.hpp"

namespace iksel {

class TaskSearch {
 public:
  TaskSearch(const ChainModel& model, const DatabaseData& data, const SolverOptions& options,
             Selection& selection);

  /// Calls `accept(q)` for every converged q until it says true, or the work bound is reached;
  /// true if it did. `seed` may be null. Counts seeds and iterations; `outside_limits` is set if an
  /// attempt reached the task outside the limits.
  template <typename Accept>
  bool run(const Pose& target, const TaskSpace& task, const JointVector* seed, StageClock& clock,
           int& attempts, int& iterations, bool& outside_limits, const Accept& accept);

 private:
  void start();
  /// The best seed, of samples not tried yet, for a pose that the task allows.
  JointVector seed_for(const Pose& target, const TaskSpace& task, const Pose& allowed);
  JointVector random_configuration();
  /// A pose that the task allows: the one nearest to the target first, then at random.
  Pose allowed_pose(const Pose& target, const TaskSpace& task, int round);

  const ChainModel& model_;
  const DatabaseData& data_;
  const SolverOptions& options_;
  Selection& selection_;
  std::unique_ptr<KdlChain> kdl_;
  Random random_{0};
  /// Whether a sample of the database was a seed already, and which were.
  std::vector<bool> is_tried_;
  std::vector<std::uint32_t> tried_;
};

template <typename Accept>
bool TaskSearch::run(const Pose& target, const TaskSpace& task, const JointVector* seed,
                     StageClock& clock, int& attempts, int& iterations, bool& outside_limits,
                     const Accept& accept) {
  start();
  const Pose tip_target = target * Pose(model_.tcp_inverse);
  const IterationContext context{model_, options_, target, tip_target, kdl_.get(), random_, &task};
  const auto attempt = [&](JointVector& q) {
    ++attempts;
    const Outcome outcome = iterate(context, q, iterations);
    if (outcome == Outcome::outside_limits) outside_limits = true;
    const bool accepted = outcome == Outcome::solved && accept(q);
    clock.lap(&StageTimes::iterate);
    return accepted;
  };
  if (seed != nullptr) {
    JointVector q = *seed;
    if (attempt(q)) return true;
  }
  for (int round = 0; round < options_.max_attempts; ++round) {
    JointVector q = round % 4 == 3 ? random_configuration()
                                   : seed_for(target, task, allowed_pose(target, task, round));
    clock.lap(&StageTimes::query);
    if (attempt(q)) return true;
  }
  return false;
}

}  // namespace iksel
