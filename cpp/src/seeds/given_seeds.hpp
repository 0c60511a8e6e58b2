// SPDX-License-Identifier: BSD-3-Clause
// Seeds that a request gives, best first. They come on top of max_attempts, which bounds how many
// of them are tried.
#pragma once

#include <algorithm>
#include <vector>

#include "base/function_ref.hpp"
#include "base/work.hpp"
#include "iksel/types.hpp"
#include "seeds/seed_ranking.hpp"

namespace iksel {

class GivenSeeds {
 public:
  /// A stage has `per_stage` seeds. `should_continue` is asked while they are ranked.
  GivenSeeds(SeedRanking& ranking, const Goal& goal, const std::vector<JointVector>& seeds,
             int most, int per_stage, FunctionRef<bool()> should_continue, Work& work)
      : ranking_(ranking),
        goal_(goal),
        seeds_(seeds),
        left_(most),
        per_stage_(per_stage),
        should_continue_(should_continue),
        work_(work) {}

  bool next_stage() {
    left_in_stage_ = std::min(left_, per_stage_);
    left_ -= left_in_stage_;
    if (seeds_.empty() || left_in_stage_ == 0 || is_empty_) return false;
    if (!ranked_) {
      // Interrupted by the deadline, the stage is empty, and the search then ends.
      ranking_.rank(goal_, seeds_, should_continue_);
      ranked_ = true;
    }
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (left_in_stage_ == 0) return false;
    --left_in_stage_;
    const double* seed = ranking_.next();
    if (seed == nullptr) {
      is_empty_ = true;
      return false;
    }
    work_.take_on_top();
    refiner.load_seed(lane, seed);
    return true;
  }

 private:
  SeedRanking& ranking_;
  const Goal& goal_;
  const std::vector<JointVector>& seeds_;
  int left_;
  int per_stage_;
  FunctionRef<bool()> should_continue_;
  Work& work_;
  bool ranked_ = false;
  bool is_empty_ = false;
  int left_in_stage_ = 0;
};

}  // namespace iksel
