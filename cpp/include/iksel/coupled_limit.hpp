// SPDX-License-Identifier: BSD-3-Clause
// Limits of sums of joint values, beside those of each joint.
#pragma once

#include <limits>
#include <map>
#include <string>

#include "iksel/export.hpp"

namespace iksel {

/// A limit that joints share, as a parallel linkage or a cable makes it:
/// lower <= sum of coefficient * joint value <= upper.
struct CoupledLimit {
  /// Coefficients by joint name; not 0. Joints between base and tip, mimic and locked ones too, but
  /// none that turns without limits.
  std::map<std::string, double> coefficients;
  double lower = -std::numeric_limits<double>::infinity();  ///< least value of the sum [rad or m]
  double upper = std::numeric_limits<double>::infinity();   ///< largest value [rad or m]; one of
                                                            ///< the two may be infinite
};

inline bool operator==(const CoupledLimit& a, const CoupledLimit& b) {
  return a.coefficients == b.coefficients && a.lower == b.lower && a.upper == b.upper;
}
inline bool operator!=(const CoupledLimit& a, const CoupledLimit& b) { return !(a == b); }

/// What is limited: "joint_2 + 0.5 joint_3".
IKSEL_EXPORT std::string to_string(const CoupledLimit& limit);

/// Coupled limits that a robot may have, at most.
inline constexpr int kMaxCoupledLimits = 8;

}  // namespace iksel
