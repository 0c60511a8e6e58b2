// SPDX-License-Identifier: BSD-3-Clause
// The samples of the leaf that a target falls into, best first: of one target in all lanes, and of
// each target of a batch, which has a lane to itself.
#pragma once

#include <algorithm>

#include "base/work.hpp"
#include "goal/goal.hpp"
#include "refine/lane_refiner.hpp"
#include "seeds/lane_query.hpp"

namespace iksel {

class LeafSeeds {
 public:
  /// `most`: of the best of them.
  LeafSeeds(LaneQuery& query, int most, Work& work) : query_(query), most_(most), work_(work) {}

  bool next_stage() {
    work_.lap(&StageTimes::iterate);
    if (done_) return false;
    done_ = true;
    query_.prepare_leaf();
    work_.lap(&StageTimes::rank);
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (rank_ == most_ || !work_.take()) return false;
    query_.load(rank_++, refiner, lane);
    return true;
  }

 private:
  LaneQuery& query_;
  int most_;
  Work& work_;
  bool done_ = false;
  int rank_ = 0;
};

/// What BatchStream gives its targets to start from.
class LeafLanes {
 public:
  LeafLanes(LaneQuery& query, int max_attempts)
      : query_(query), most_(std::min(kSeeds, max_attempts)) {}

  /// The lane's target from now on. Y (reduction.hpp) is that of the pose nearest to it that the
  /// task allows.
  void begin(LaneRefiner& refiner, int lane, const Goal& goal, const Pose& Y) {
    if (goal.is_full_pose()) {
      refiner.set_pose(lane, Y);
    } else {
      refiner.set_task(lane, goal.target());
    }
    lanes_[lane] = {Y, 0};
  }
  /// Starts the lane at the target's next seed; false if there are no more.
  bool load(LaneRefiner& refiner, int lane) {
    Lane& in = lanes_[lane];
    if (in.seeds == most_) return false;
    query_.set_target(in.Y);
    query_.prepare_leaf();
    query_.load(in.seeds++, refiner, lane);
    return true;
  }
  [[nodiscard]] int attempts(int lane) const { return lanes_[lane].seeds; }
  /// The lane's seed has arrived where there is no answer.
  void refuse(int /*lane*/) {}
  /// What it proves that none of a target's seeds is an answer.
  [[nodiscard]] Proof proof(int /*lane*/) const { return Proof::none; }

 private:
  /// Seeds that a target is given before it is left.
  static constexpr int kSeeds = 2;

  struct Lane {
    Pose Y;
    int seeds;
  };
  LaneQuery& query_;
  int most_;
  Lane lanes_[lanes::kWidth];
};

}  // namespace iksel
