// SPDX-License-Identifier: BSD-3-Clause
// The samples of the leaf that the target falls into, best first.
#pragma once

#include "base/work.hpp"
#include "seeds/lane_query.hpp"

namespace iksel {

class LeafSeeds {
 public:
  /// `most`: of the best of them.
  LeafSeeds(LaneQuery& query, int most, Work& work, StageClock& clock)
      : query_(query), most_(most), work_(work), clock_(clock) {}

  bool next_stage() {
    clock_.lap(&StageTimes::iterate);
    if (done_) return false;
    done_ = true;
    query_.prepare_leaf(query_.packs[0]);
    clock_.lap(&StageTimes::rank);
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (rank_ == most_ || !work_.take()) return false;
    load_ranked(query_.packs[0], rank_++, refiner, lane);
    return true;
  }

 private:
  LaneQuery& query_;
  int most_;
  Work& work_;
  StageClock& clock_;
  bool done_ = false;
  int rank_ = 0;
};

}  // namespace iksel
