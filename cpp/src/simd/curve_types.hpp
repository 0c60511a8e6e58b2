// SPDX-License-Identifier: BSD-3-Clause
// Where the lanes of a pack stand on self-motions of seven joints.
#pragma once

#include "base/constants.hpp"
#include "simd/lane_types.hpp"

namespace iksel::lanes {

using iksel::kCurveJoints;

/// All lanes reach the same pose, given as RoughPack gives it.
struct CurvePack {
  double target[kFullPoseRows];
  alignas(64) double q[kCurveJoints][kWidth];
  /// Unit vectors along the curves, the way that each lane goes.
  alignas(64) double tangent[kCurveJoints][kWidth];
  /// 1 where tangents are oriented that way, else -1.
  alignas(64) double side[kWidth];
  alignas(64) double step[kWidth];  ///< length of the next step [rad and m]
  double longest;                   ///< what it may become
};

}  // namespace iksel::lanes
