// SPDX-License-Identifier: BSD-3-Clause
// The database's seeds as the paper selects them: query, rank, re-select; one a stage.
#pragma once

#include "base/work.hpp"
#include "seeds/selection.hpp"

namespace iksel {

class SelectedSeeds {
 public:
  SelectedSeeds(Selection& selection, const Pose& tip_target, Work& work, StageClock& clock)
      : selection_(selection), tip_target_(tip_target), work_(work), clock_(clock) {}

  bool next_stage() {
    clock_.lap(&StageTimes::iterate);
    if (!ranked_) {
      ranked_ = true;
      selection_.query(tip_target_);
      clock_.lap(&StageTimes::query);
      selection_.rank();
      clock_.lap(&StageTimes::rank);
    }
    seed_ = work_.has_left() ? selection_.next_seed() : nullptr;
    clock_.lap(&StageTimes::reselect);
    return seed_ != nullptr;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (seed_ == nullptr || !work_.take()) return false;
    refiner.load_seed(lane, seed_);
    seed_ = nullptr;
    return true;
  }

 private:
  Selection& selection_;
  Pose tip_target_;
  Work& work_;
  StageClock& clock_;
  bool ranked_ = false;
  const double* seed_ = nullptr;
};

}  // namespace iksel
