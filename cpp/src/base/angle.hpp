// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "base/constants.hpp"

namespace iksel {

/// What is left of an angle without whole turns, from -pi to pi [rad].
inline double without_turns(double angle) {
  if (std::abs(angle) <= kPi) return angle;
  // One turn is taken off exactly, and sooner.
  if (std::abs(angle) < 3 * kPi) return angle - std::copysign(kTwoPi, angle);
  return std::remainder(angle, kTwoPi);
}

}  // namespace iksel
