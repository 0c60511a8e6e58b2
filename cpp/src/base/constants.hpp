// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace iksel {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTwoPi = 2.0 * kPi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What rounding may leave of joint values and directions, and beyond [rad, and m or parts of the
/// reach].
inline constexpr double kRounding = 1e-9;
/// How far apart answers of one solution may be, by the default tolerances [rad or m].
inline constexpr double kSameAnswer = 1e-6;

/// Longest step of a joint while it goes downhill: what it is led by is of the first or second
/// order [rad or m].
inline constexpr double kLongestStep = 0.5;
/// A seed this near to a solution in every joint would end there itself [rad or m]; or at the other
/// of a pair that is near.
inline constexpr double kBasinRadius = 0.2;

/// Most joints that move on a chain (mimic joints come on top of the degrees of freedom).
inline constexpr int kMaxMovingJoints = 64;
/// Joints that a pose fixes.
inline constexpr int kPoseJoints = 6;
/// Joints of an arm whose solutions of a pose are a curve: one more than the pose fixes.
inline constexpr int kCurveJoints = kPoseJoints + 1;
/// Most images that the joints in limited sums may have together.
inline constexpr int kMostImagesInSums = 64;

}  // namespace iksel
