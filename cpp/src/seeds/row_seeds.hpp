// SPDX-License-Identifier: BSD-3-Clause
// Seeds that are there already, row by row: along the arcs of a self-motion, where a path comes
// from, or the one configuration to stay near.
#pragma once

#include <array>
#include <cstddef>

#include "base/work.hpp"
#include "iksel/types.hpp"
#include "simd/lane_types.hpp"

namespace iksel {

class RowSeeds {
 public:
  /// `count` rows of `dof` joint values at q, each as near to an answer as its maker can tell
  /// (`are_answers`), or only a seed. They come on top of those that `work` allows.
  RowSeeds(const double* q, std::size_t count, std::size_t dof, bool are_answers, Work& work)
      : q_(q), count_(count), dof_(dof), are_answers_(are_answers), work_(work) {}
  /// A seed that may be null: there is none then.
  RowSeeds(const JointVector* q, Work& work)
      : RowSeeds(q != nullptr ? q->data() : nullptr, q != nullptr ? 1 : 0, 0, false, work) {}

  [[nodiscard]] bool next_stage() const { return next_ < count_; }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (next_ == count_) return false;
    work_.take_on_top();
    row_[static_cast<std::size_t>(lane)] = next_;
    const double* q = q_ + next_++ * dof_;
    if (are_answers_) {
      refiner.load_answer(lane, q);
    } else {
      refiner.load_seed(lane, q);
    }
    return true;
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  /// The one that a lane was loaded with last.
  [[nodiscard]] std::size_t row(int lane) const { return row_[static_cast<std::size_t>(lane)]; }

 private:
  const double* q_;
  std::size_t count_, dof_;
  bool are_answers_;
  Work& work_;
  std::size_t next_ = 0;
  std::array<std::size_t, lanes::kWidth> row_{};
};

}  // namespace iksel
