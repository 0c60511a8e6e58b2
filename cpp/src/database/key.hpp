// SPDX-License-Identifier: BSD-3-Clause
// The point that stands for a pose in the KD-tree: position [m], then the weighted rotation; or a
// dual quaternion of both.
#pragma once

#include "base/rotation.hpp"
#include "iksel/options.hpp"
#include "iksel/types.hpp"

namespace iksel {

inline constexpr int kMaxKeyDimension = 12;

inline int key_dimension(RotationKey key) {
  switch (key) {
    case RotationKey::quaternion:
      return 7;
    case RotationKey::dual_quaternion:
      return 8;
    case RotationKey::matrix:
      return 12;
    case RotationKey::rotation_vector:
    case RotationKey::euler:
      break;
  }
  return 6;
}

/// The weight that the options mean.
inline double rotation_weight(const DatabaseOptions& options, double reach) {
  return options.rotation_weight > 0 ? options.rotation_weight : 0.25 * reach;
}

/// Dual part of the unit dual quaternion of a pose: half the quaternion product (0, position) r,
/// for its real part r (w, x, y, z) [m].
inline Eigen::Vector4d dual_part(const Eigen::Vector3d& position, const Eigen::Vector4d& r) {
  Eigen::Vector4d dual;
  dual[0] = -0.5 * position.dot(r.tail<3>());
  dual.tail<3>() = 0.5 * (r[0] * position + position.cross(r.tail<3>()));
  return dual;
}

/// The full key.
inline void make_key(const DatabaseOptions& options, double weight, const Pose& pose, double* key) {
  const Eigen::Matrix3d R = pose.linear();
  const auto write = [&](double* at, const auto& values, double scale) {
    for (Eigen::Index i = 0; i < values.size(); ++i) at[i] = scale * values.data()[i];
  };
  const Eigen::Vector3d position = pose.translation();
  if (options.rotation_key == RotationKey::dual_quaternion) {
    const Eigen::Vector4d real = to_quaternion_wxyz(R);
    write(key, real, weight);
    return write(key + 4, dual_part(position, real), 1.0);
  }
  write(key, position, 1.0);
  switch (options.rotation_key) {
    case RotationKey::rotation_vector:
      return write(key + 3, to_rotation_vector(R), weight);
    case RotationKey::quaternion:
      return write(key + 3, to_quaternion_wxyz(R), weight);
    case RotationKey::matrix:
      return write(key + 3, R, weight);
    case RotationKey::euler:
      return write(key + 3, to_roll_pitch_yaw(R), weight);
    case RotationKey::dual_quaternion:
      break;
  }
}

}  // namespace iksel
