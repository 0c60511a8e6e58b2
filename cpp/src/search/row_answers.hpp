// SPDX-License-Identifier: BSD-3-Clause
// The answers to rows of seeds, each at its seed's place.
#pragma once

#include <vector>

#include "goal/goal.hpp"
#include "refine/lane_refiner.hpp"
#include "search/search.hpp"
#include "seeds/row_seeds.hpp"

namespace iksel {

class RowAnswers {
 public:
  /// All must outlive this.
  RowAnswers(const Goal& goal, const RowSeeds& seeds)
      : goal_(goal), seeds_(seeds), answers_(seeds.count()) {}

  /// An answer stays at its seed's images: whole turns are not taken off.
  Verdict offer(int lane, JointVector& q) {
    Result& answer = answers_[seeds_.row(lane)];
    return goal_.check(goal_.joints().clamp(q), answer) ? Verdict::next : Verdict::refine;
  }
  template <typename Q>
  [[nodiscard]] bool knows(const Q& /*q*/) const {
    return false;
  }
  [[nodiscard]] bool should_continue() const { return true; }

  /// Not a success where a seed led to none.
  [[nodiscard]] const Result& at(std::size_t row) const { return answers_[row]; }

 private:
  const Goal& goal_;
  const RowSeeds& seeds_;
  std::vector<Result> answers_;
};

/// Refines rows of seeds of a full pose, given by its Y (reduction.hpp).
inline RowAnswers refine_rows(RowSeeds& seeds, const Goal& goal, const Pose& Y,
                              const Patience& patience, LaneRefiner& refiner, Work& work) {
  RowAnswers answers(goal, seeds);
  refiner.begin(goal.task(), patience, Width::wide);
  refiner.set_target(Y, goal.target());
  search(refiner, seeds, answers, work);
  return answers;
}

}  // namespace iksel
