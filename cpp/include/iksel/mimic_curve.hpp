// SPDX-License-Identifier: BSD-3-Clause
// How a joint follows another where that is no straight line.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "iksel/export.hpp"

namespace iksel {

/// A joint that follows another by a smooth curve, as a four-bar linkage or a cylinder beside a
/// hinge makes it. It takes the place of the joint's mimic tag, which knows straight lines only.
///
/// Between the points lies a cubic in each gap (Hermite's); the joint that is followed stays
/// between the first point and the last.
struct MimicCurve {
  std::string joint;    ///< name of the joint that follows
  std::string follows;  ///< name of the joint that is followed; it follows none itself
  /// Values of the joint that is followed [rad or m], two or more, each above the one before.
  std::vector<double> q;
  /// Value of `joint` at each [rad or m].
  std::vector<double> values;
  /// Derivative of `values` by q at each. Empty: those of the cubic spline through the points,
  /// whose second derivative has no steps.
  std::vector<double> slopes;

  /// Value and derivative of the curve at a value of the joint that is followed.
  using Function = std::function<std::pair<double, double>(double)>;

  /// The curve of a function, between `lower` and `upper`: with so many points that it lies within
  /// 1e-10 [rad or m] of the function between them.
  ///
  /// Throws InvalidArgumentError if the limits are no good, and if 8,192 gaps are not enough, as
  /// where the derivative is that of another function.
  static IKSEL_EXPORT MimicCurve sampled(const std::string& joint, const std::string& follows,
                                         double lower, double upper, const Function& function);
};

inline bool operator==(const MimicCurve& a, const MimicCurve& b) {
  return a.joint == b.joint && a.follows == b.follows && a.q == b.q && a.values == b.values &&
         a.slopes == b.slopes;
}
inline bool operator!=(const MimicCurve& a, const MimicCurve& b) { return !(a == b); }

}  // namespace iksel
