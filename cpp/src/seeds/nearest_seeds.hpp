// SPDX-License-Identifier: BSD-3-Clause
// The samples nearest to the target: those of its leaf first, then the exact neighbours in widening
// stages.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/work.hpp"
#include "seeds/lane_query.hpp"

namespace iksel {

class NearestSeeds {
 public:
  /// `only_leaf`: the first of them only.
  NearestSeeds(LaneQuery& query, bool only_leaf, Work& work, StageClock& clock)
      : query_(query), only_leaf_(only_leaf), work_(work), clock_(clock) {}

  bool next_stage() {
    clock_.lap(&StageTimes::iterate);
    rank_ = 0;
    if (!leaf_done_) {
      leaf_done_ = true;
      query_.prepare_leaf(seeds());
    } else if (only_leaf_ || !prepare_next()) {
      return false;
    }
    clock_.lap(&StageTimes::rank);
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (rank_ == lanes::kBlock || !work_.take()) return false;
    load_ranked(seeds(), rank_++, refiner, lane);
    return true;
  }

 private:
  lanes::SeedPack& seeds() { return query_.packs[0]; }

  /// Each stage asks for four times as many and tries those that were not tried yet. Their number
  /// ends them, and not how many the tree finds: keys may be far out of its range.
  bool prepare_next() {
    while (done_ == found_) {
      if (asked_ == query_.neighbours() || !work_.has_left()) return false;
      asked_ = std::min(std::max<std::size_t>(64, 4 * asked_), query_.neighbours());
      found_ = query_.find_nearest(asked_);
      clock_.lap(&StageTimes::query);
    }
    query_.prepare_nearest(done_, found_, seeds());
    done_ = std::min(done_ + lanes::kBlock, found_);
    return true;
  }

  LaneQuery& query_;
  bool only_leaf_;
  Work& work_;
  StageClock& clock_;
  bool leaf_done_ = false;
  int rank_ = 0;
  std::size_t asked_ = 0;
  std::size_t found_ = 0;
  std::size_t done_ = 0;
};

}  // namespace iksel
