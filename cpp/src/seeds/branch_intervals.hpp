// SPDX-License-Identifier: BSD-3-Clause
// Intervals of the swept joint's values in which a branch may be an answer although it is none at
// either end: divided until one is found, or none can be there.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/function_ref.hpp"
#include "seeds/swept_branches.hpp"

namespace iksel {

class BranchIntervals {
 public:
  BranchIntervals();

  /// Begins with the whole range, of every branch; `branches` has to outlive what follows.
  void begin(SweptBranches& branches);
  /// Divides each into nine, and leaves those that cannot have an answer. True once the branch in
  /// that lane is an answer that is taken.
  bool divide(FunctionRef<bool(int lane, int branch)> take);
  [[nodiscard]] bool is_empty() const { return intervals_.empty(); }
  /// Whether there were too many to be looked at.
  [[nodiscard]] bool is_overfull() const { return is_overfull_; }
  /// Visits what is left: a branch, and a value of the swept joint.
  template <typename Visit>
  void visit(const Visit& visit) const {
    for (const Interval& interval : intervals_) {
      visit(interval.branch, 0.5 * (interval.lower.value + interval.upper.value));
    }
  }

 private:
  /// Values of the swept joint to begin with, evenly over its range.
  static constexpr int kPlaces = 32;
  /// More are left out.
  static constexpr std::size_t kMost = 512;

  struct Interval {
    int branch;
    BranchNode lower, upper;
  };
  /// Adds those between consecutive nodes that may have an answer.
  void add(int branch, int intervals);
  /// Whether a joint that is beyond a limit at both of two nodes may have come back between them,
  /// by how far it goes there, and to the nodes beside.
  [[nodiscard]] bool may_have_answer(const BranchNode& lower, const BranchNode& upper,
                                     const BranchWay& before, const BranchWay& here,
                                     const BranchWay& behind) const;

  SweptBranches* branches_ = nullptr;
  std::array<BranchNode, kPlaces + 1> nodes_;
  std::vector<Interval> intervals_, divided_;
  int round_ = 0;
  bool is_overfull_ = false;
};

}  // namespace iksel
