// SPDX-License-Identifier: BSD-3-Clause
// Limits of sums of joint values, as the kernels take them: plain numbers (lane_types.hpp).
#pragma once

#include "base/constants.hpp"

namespace iksel::lanes {

/// Most coupled limits, as kMaxCoupledLimits.
inline constexpr int kMostCoupled = 8;

/// Over seven joints: six as a closed form counts them, and the held one. Scaled so that the sizes
/// of a row's coefficients add up to 1: angles that are off by e take a sum off by no more.
struct CoupledForm {
  int rows;
  double coefficient[kMostCoupled][7];
  double lower[kMostCoupled], upper[kMostCoupled];
  /// Joints whose whole turns count; the middle of their limits and half their range [rad]; and
  /// their images together: what each adds to those nearest to the middle [rad].
  int turning;
  int joint[7];
  double middle[7], reach[7];
  int images;
  double turned[kMostCoupledImages][7];
  double held_offset;  ///< what the held angle is more than its joint's value [rad]
};

}  // namespace iksel::lanes
