// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace iksel {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTwoPi = 2.0 * kPi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace iksel
