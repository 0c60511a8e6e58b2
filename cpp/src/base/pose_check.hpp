// SPDX-License-Identifier: BSD-3-Clause
// What counts as a pose, and the nearest one to a matrix that is a little off. The one place that
// every pose from outside goes through.
#pragma once

#include <cstddef>

#include "iksel/types.hpp"

namespace iksel {

/// How far a matrix is from a rigid transform.
enum class Rigidity {
  exact,  ///< it is one, to rounding
  close,  ///< its rotation is off by kRigidTolerance or less
  none,   ///< it is none
};

Rigidity rigidity_of(const Pose& pose);

/// Projects the rotation of a close one to the nearest rotation.
void make_rigid(Pose& pose);

/// Throws InvalidArgumentError that says why `pose`, whose rigidity is none, is none; `index` >= 0
/// is named in the message.
[[noreturn]] void throw_not_rigid(const Pose& pose, const char* name, std::ptrdiff_t index = -1);

/// The pose itself, bit for bit, if it is rigid to rounding, else the nearest that is, in
/// `nearest`. Throws as check_pose.
const Pose& to_rigid(const Pose& pose, Pose& nearest, const char* name = "pose",
                     std::ptrdiff_t index = -1);

/// Pose of a row-major 4x4 matrix.
inline Pose to_pose(const double* row_major) {
  Pose pose;
  pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(row_major);
  return pose;
}

}  // namespace iksel
