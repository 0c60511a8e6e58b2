// SPDX-License-Identifier: BSD-3-Clause
// The configuration inside the limits from which the least is missing of a goal, near a seed.
#pragma once

#include "base/constants.hpp"
#include "refine/remainder.hpp"

namespace iksel {

/// So many more steps that gain as much as the last must be enough to come below the best so far.
inline constexpr double kHopefulSteps = 30;

/// Moves q, inside the limits, to a local minimum in at most `most` steps, by Newton's method with
/// the limits as an active set (Bertsekas: "Projected Newton methods", SIAM J. Control and
/// Optimization 20, 1982) and damped as Levenberg-Marquardt. Given up where it will most likely not
/// come below `best`. Returns the remainder there; `steps` counts those taken.
double descend_to_closest(const Remainder& remainder, int most, JointVector& q, int& steps,
                          double best = kInfinity);

/// The same from a seed that may lie anywhere, without the turns that joints took on the way.
double descend_from_seed(const Remainder& remainder, int most, JointVector& q, int& steps,
                         double best = kInfinity);

/// Descents from seeds at random, where there are no lanes to find better ones.
inline constexpr int kRandomDescents = 48;

/// Where a descent ended.
struct LocalMinimum {
  double remainder;
  double move;  ///< from where the arm is to stay near, if it is
  int number;
  JointVector q;
};

}  // namespace iksel
