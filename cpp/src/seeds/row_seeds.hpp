// SPDX-License-Identifier: BSD-3-Clause
// Seeds that are there already, row by row: along the arcs of a self-motion, where a path comes
// from, or the one configuration to stay near; and what a source has ready for each of its stages.
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
  RowSeeds(const double* q, std::size_t count, std::size_t dof, bool are_answers, Work& work,
           bool (Work::*take)() = &Work::take_on_top)
      : RowSeeds(work, take) {
    give(q, count, dof, are_answers);
  }
  /// A seed that may be null: there is none then.
  RowSeeds(const JointVector* q, Work& work)
      : RowSeeds(q != nullptr ? q->data() : nullptr, q != nullptr ? 1 : 0, 0, false, work) {}

  [[nodiscard]] bool next_stage() const { return !is_through(); }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (is_through() || !(work_.*take_)()) return false;
    row_[static_cast<std::size_t>(lane)] = next_;
    const double* q = q_ + next_++ * stride_;
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

 protected:
  /// A source of which each stage gives rows; `take` counts one, if there may be more.
  RowSeeds(Work& work, bool (Work::*take)()) : work_(work), take_(take) {}
  /// The rows from now on, each `stride` numbers behind the one before.
  void give(const double* q, std::size_t count, std::size_t stride, bool are_answers) {
    q_ = q;
    count_ = count;
    stride_ = stride;
    are_answers_ = are_answers;
    next_ = 0;
  }
  /// Whether all rows were loaded.
  [[nodiscard]] bool is_through() const { return next_ == count_; }

  Work& work_;

 private:
  bool (Work::*take_)();
  const double* q_ = nullptr;
  std::size_t count_ = 0, stride_ = 0;
  bool are_answers_ = false;
  std::size_t next_ = 0;
  std::array<std::size_t, lanes::kWidth> row_{};
};

}  // namespace iksel
