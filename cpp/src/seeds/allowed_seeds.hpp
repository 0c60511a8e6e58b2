// SPDX-License-Identifier: BSD-3-Clause
// Seeds for a task, a block at a time: samples near to poses that it allows, the pose nearest to
// the target first; between them configurations at random.
#pragma once

#include <cstdint>

#include "base/random.hpp"
#include "base/stage_clock.hpp"
#include "base/work.hpp"
#include "goal/goal.hpp"
#include "seeds/lane_query.hpp"
#include "seeds/random_seeds.hpp"

namespace iksel {

class AllowedSeeds {
 public:
  AllowedSeeds(LaneQuery& query, const JointSpace& joints, const Goal& goal, std::uint64_t seed,
               Work& work, StageClock& clock)
      : query_(query), joints_(joints), goal_(goal), random_(seed), work_(work), clock_(clock) {}

  bool next_stage() {
    clock_.lap(&StageTimes::iterate);
    if (!work_.has_left()) return false;
    at_random_ = stage_ % 4 == 3;
    rank_ = 0;
    if (stage_ == 0) {
      query_.set_target(goal_.nearest_pose());
      query_.prepare_leaf(query_.packs[0]);
      query_.forget();
    } else if (!at_random_) {
      // Some poses have the same samples: a spin about the last joint is not in a reduced key.
      query_.set_target(goal_.random_pose(random_));
      at_random_ = !query_.prepare_untried(query_.packs[0]);
    }
    ++stage_;
    clock_.lap(&StageTimes::query);
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (rank_ == lanes::kBlock || !work_.take()) return false;
    const int rank = rank_++;
    if (at_random_) {
      load_random(joints_, random_, refiner, lane);
    } else {
      load_ranked(query_.packs[0], rank, refiner, lane);
    }
    return true;
  }

 private:
  LaneQuery& query_;
  const JointSpace& joints_;
  const Goal& goal_;
  Random random_;
  Work& work_;
  StageClock& clock_;
  int stage_ = 0;
  bool at_random_ = false;
  int rank_ = 0;
};

}  // namespace iksel
