// SPDX-License-Identifier: BSD-3-Clause
// What counts as a pose, and how far two are apart.
#pragma once

#include "iksel/export.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// The rotation vector and position differences of two poses: [p_target - p; rotvec(R_target R^T)].
IKSEL_EXPORT Eigen::Matrix<double, 6, 1> pose_error(const Pose& target, const Pose& pose);

/// The rigid transform that `pose` stands for: itself, bit for bit, if it is one to rounding
/// (|R^T R - I| <= 1e-12), else the nearest, by polar decomposition. Throws InvalidArgumentError if
/// it is not finite, its rotation is off by more than kRigidTolerance or mirrored, or its last row
/// is not 0 0 0 1; `name` names the culprit in the message. Every pose that comes into the library
/// goes through this.
IKSEL_EXPORT Pose check_pose(const Pose& pose, const char* name = "pose");

/// Largest element of |R^T R - I|; infinite if `pose` is not finite, mirrored, or not 0 0 0 1 in
/// its last row.
[[nodiscard]] IKSEL_EXPORT double rigid_deviation(const Pose& pose);

/// The rigid transform nearest to `pose`, however far off its rotation is: scaled, sheared or
/// rounded to two decimals. Throws InvalidArgumentError if it is not finite, singular or mirrored,
/// or its last row is not 0 0 0 1.
[[nodiscard]] IKSEL_EXPORT Pose orthonormalized(const Pose& pose, const char* name = "pose");

}  // namespace iksel
