// SPDX-License-Identifier: BSD-3-Clause
// Seeds for a task, which allows many poses.
#pragma once

#include "base/random.hpp"
#include "base/work.hpp"
#include "goal/goal.hpp"
#include "seeds/random_seeds.hpp"

namespace iksel {

/// Samples near to poses that the task allows, the pose nearest to the target first; between them
/// configurations at random. `Samples` (lane_query.hpp, task_samples.hpp) has kPerPose, how many
/// seeds a pose is good for; find(goal, pose, is_first), false where all near to it were tried; and
/// load(rank, refiner, lane).
template <typename Samples>
class AllowedSeeds {
 public:
  AllowedSeeds(Samples& samples, const Goal& goal, Random& random, Work& work)
      : samples_(samples), goal_(goal), random_(random), work_(work) {}

  bool next_stage() {
    work_.lap(&StageTimes::iterate);
    if (!work_.has_left()) return false;
    at_random_ = stage_ % 4 == 3;
    rank_ = 0;
    if (!at_random_) {
      const bool is_first = stage_ == 0;
      // Some poses have the same samples: a spin about the last joint is not in a reduced key.
      const Pose pose = is_first ? goal_.nearest_pose() : goal_.random_pose(random_);
      at_random_ = !samples_.find(goal_, pose, is_first);
    }
    ++stage_;
    work_.lap(&StageTimes::query);
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (rank_ == Samples::kPerPose || !work_.take()) return false;
    const int rank = rank_++;
    if (at_random_) {
      load_random(goal_.joints(), random_, refiner, lane);
    } else {
      samples_.load(rank, refiner, lane);
    }
    return true;
  }

 private:
  Samples& samples_;
  const Goal& goal_;
  Random& random_;
  Work& work_;
  int stage_ = 0;
  bool at_random_ = false;
  int rank_ = 0;
};

}  // namespace iksel
