// SPDX-License-Identifier: BSD-3-Clause
// Seeds for a task that leaves something of the pose open: for some of the poses that the task
// allows, the one nearest to the task first, between them configurations at random.
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.hpp"
#include "base/stage_clock.hpp"
#include "base/work.hpp"
#include "goal/goal.hpp"
#include "seeds/selection.hpp"

namespace iksel {

class TaskSeeds {
 public:
  TaskSeeds(const ChainModel& model, const DatabaseData& data, const SolverOptions& options,
            Selection& selection);

  /// Neighbours of a pose that a seed is the best of: few where any answer will do, many to find
  /// answers that differ.
  static constexpr std::size_t kFew = 4;
  static constexpr std::size_t kMany = 16;

  /// Before a search; all must outlive it.
  void begin(const Goal& goal, std::size_t neighbours, int per_stage, Work& work,
             StageClock& clock);
  /// What the search's restarts are drawn from too.
  [[nodiscard]] Random& random() { return random_; }

  bool next_stage() {
    clock_->lap(&StageTimes::iterate);
    left_in_stage_ = per_stage_;
    return work_->has_left();
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (left_in_stage_ == 0 || !work_->take()) return false;
    --left_in_stage_;
    refiner.load_seed(lane, next().data());
    clock_->lap(&StageTimes::query);
    return true;
  }

 private:
  JointVector next();
  /// The best seed, of samples not tried yet, for a pose that the task allows.
  JointVector seed_for(const Pose& allowed);
  JointVector random_configuration();

  const ChainModel& model_;
  const DatabaseData& data_;
  const SolverOptions& options_;
  Selection& selection_;
  Random random_{0};
  /// Whether a sample of the database was a seed already, and which were.
  std::vector<bool> is_tried_;
  std::vector<std::uint32_t> tried_;
  const Goal* goal_ = nullptr;
  std::size_t neighbours_ = kMany;
  int per_stage_ = 1;
  Work* work_ = nullptr;
  StageClock* clock_ = nullptr;
  int left_in_stage_ = 0;
  int round_ = 0;
};

}  // namespace iksel
