// SPDX-License-Identifier: BSD-3-Clause
// Checks of arguments, and the words of their errors.
#pragma once

#include <cstddef>

#include "iksel/types.hpp"

namespace iksel {

/// Throws InvalidArgumentError unless q has `dof` finite elements.
void check_joints(const JointVector& q, int dof, const char* name);

/// Throws InvalidArgumentError unless the row-major 4x4 matrix is a rigid transform; `index` >= 0
/// is named in the message.
void check_matrix(const double* row_major, const char* name, std::ptrdiff_t index = -1);

/// Pose of a row-major 4x4 matrix.
inline Pose to_pose(const double* row_major) {
  Pose pose;
  pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(row_major);
  return pose;
}

}  // namespace iksel
