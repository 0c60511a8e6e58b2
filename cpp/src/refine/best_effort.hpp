// SPDX-License-Identifier: BSD-3-Clause
// The least error inside the limits, for a task that has no answer there.
#pragma once

#include <cstdint>
#include <vector>

#include "base/constants.hpp"
#include "refine/closest_descent.hpp"

namespace iksel {

/// Seeds of a best effort at random.
inline constexpr int kEfforts = 24;

class BestEffort {
 public:
  /// `weight` is the length that 1 rad counts [m].
  BestEffort(const Goal& goal, double weight);

  /// Where it ended.
  JointVector from(const JointVector& seed);
  /// From n configurations spread over the limits by a seed.
  std::vector<JointVector> from_anywhere(int n, std::uint64_t seed);
  [[nodiscard]] const JointVector& q() const { return q_; }

 private:
  Remainder remainder_;
  double least_ = kInfinity;
  JointVector q_;
};

/// Moves q, which is near to a solution, to where it is an answer inside the limits, if it finds
/// such a place: at a limit the tolerances may be needed to their edge, of position and of rotation
/// each.
bool descend_into_tolerances(const Goal& goal, JointVector& q);

}  // namespace iksel
