// SPDX-License-Identifier: BSD-3-Clause
// The pipeline for a task that leaves something of the pose open: seeds for some of the poses that
// the task allows, the one nearest to the task first, between them configurations at random.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/stage_clock.hpp"
#include "database/data.hpp"
#include "refine/iterate.hpp"
#include "search/lane_search.hpp"
#include "seeds/selection.hpp"

namespace iksel {

class TaskSearch {
 public:
  struct Always {
    bool operator()() const { return true; }
  };

  TaskSearch(const ChainModel& model, const DatabaseData& data, const SolverOptions& options,
             Selection& selection);

  /// Neighbours of a pose that a seed is the best of: few where any answer will do, many to find
  /// answers that differ.
  static constexpr std::size_t kFew = 4;
  static constexpr std::size_t kMany = 16;

  /// Sets what attempt() and run() are to reach; both must outlive them.
  void begin(const Pose& target, const TaskSpace& task, std::size_t neighbours);

  /// Iterates from a seed and calls `accept(JointVector& q) -> Verdict` if it arrives; true if that
  /// says stop. Counts the seed and its iterations.
  template <typename Accept>
  bool attempt(const JointVector& seed, StageClock& clock, Work& work, const Accept& accept);

  /// Attempts seeds of its own until one is accepted (then true), the work bound is reached, or
  /// `go_on()`, asked after each, says no.
  template <typename Accept, typename GoOn = Always>
  bool run(StageClock& clock, Work& work, const Accept& accept, const GoOn& go_on = {});

  /// Whether an attempt reached the task outside the limits.
  [[nodiscard]] bool left_limits() const { return left_limits_; }

 private:
  /// The best seed, of samples not tried yet, for a pose that the task allows.
  JointVector seed_for(const Pose& allowed);
  JointVector random_configuration();
  /// A pose that the task allows: the one nearest to the target first, then at random.
  Pose allowed_pose(int round);

  const ChainModel& model_;
  const DatabaseData& data_;
  const SolverOptions& options_;
  Selection& selection_;
  std::unique_ptr<KdlChain> kdl_;
  Random random_{0};
  /// Whether a sample of the database was a seed already, and which were.
  std::vector<bool> is_tried_;
  std::vector<std::uint32_t> tried_;
  const Pose* target_ = nullptr;
  const TaskSpace* task_ = nullptr;
  Pose tip_target_ = Pose::Identity();
  std::size_t neighbours_ = kMany;
  bool left_limits_ = false;
};

template <typename Accept>
bool TaskSearch::attempt(const JointVector& seed, StageClock& clock, Work& work,
                         const Accept& accept) {
  // Few that are far off after so many steps come home; where many have failed, those few count.
  constexpr int kTaskPatience = 8;
  constexpr int kHastyAttempts = 32;
  IterationContext context{model_, options_, *target_, tip_target_, kdl_.get(), random_, task_};
  if (options_.iteration == Iteration::lm && work.attempts < kHastyAttempts) {
    context.patience = kTaskPatience;
  }
  JointVector q = seed;
  ++work.attempts;
  const Outcome outcome = iterate(context, q, work.iterations);
  if (outcome == Outcome::outside_limits) left_limits_ = true;
  const bool accepted = outcome == Outcome::solved && accept(q) == Verdict::stop;
  clock.lap(&StageTimes::iterate);
  return accepted;
}

template <typename Accept, typename GoOn>
bool TaskSearch::run(StageClock& clock, Work& work, const Accept& accept, const GoOn& go_on) {
  for (int round = 0; round < options_.max_attempts; ++round) {
    const JointVector seed =
        round % 4 == 3 ? random_configuration() : seed_for(allowed_pose(round));
    clock.lap(&StageTimes::query);
    if (attempt(seed, clock, work, accept)) return true;
    if (!go_on()) return false;
  }
  return false;
}

}  // namespace iksel
