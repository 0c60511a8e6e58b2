// SPDX-License-Identifier: BSD-3-Clause
// The database's seeds as the paper selects them: query, rank, re-select; one a stage.
#pragma once

#include "seeds/row_seeds.hpp"
#include "seeds/selection.hpp"

namespace iksel {

class SelectedSeeds : public RowSeeds {
 public:
  SelectedSeeds(Selection& selection, const Pose& tip_target, Work& work)
      : RowSeeds(work, &Work::take), selection_(selection), tip_target_(tip_target) {}

  bool next_stage() {
    work_.lap(&StageTimes::iterate);
    if (!ranked_) {
      ranked_ = true;
      selection_.query(tip_target_);
      work_.lap(&StageTimes::query);
      selection_.rank();
      work_.lap(&StageTimes::rank);
    }
    const double* seed = work_.has_left() ? selection_.next_seed() : nullptr;
    give(seed, seed != nullptr ? 1 : 0, 0, /*are_answers=*/false);
    work_.lap(&StageTimes::reselect);
    return seed != nullptr;
  }

 private:
  Selection& selection_;
  Pose tip_target_;
  bool ranked_ = false;
};

}  // namespace iksel
