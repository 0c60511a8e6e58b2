// SPDX-License-Identifier: BSD-3-Clause
// Conversions between rotation matrices and vectors of numbers, robust at angles 0 and pi.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace iksel {

/// Unit quaternion (w, x, y, z) of R with w >= 0.
inline Eigen::Vector4d to_quaternion_wxyz(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  return sign * Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
}

/// A B. Eigen's product of two poses goes through temporaries, and takes three times as long.
inline Eigen::Isometry3d compose(const Eigen::Isometry3d& A, const Eigen::Isometry3d& B) {
  Eigen::Isometry3d out;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) {
      out(r, c) = A(r, 0) * B(0, c) + A(r, 1) * B(1, c) + A(r, 2) * B(2, c);
      if (c == 3) out(r, c) += A(r, 3);
    }
  }
  out.makeAffine();
  return out;
}

/// K with K x = v x x.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d K;
  K << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return K;
}

/// Rotation vector of R, length in [0, pi] [rad]. By way of the quaternion, which keeps full
/// precision at both ends of the range.
inline Eigen::Vector3d to_rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::Vector4d q = to_quaternion_wxyz(R);
  const Eigen::Vector3d v = q.tail<3>();
  const double sine = v.norm();
  // 2 atan2(s, w) / s -> 2 / w for s -> 0.
  const double factor = sine > 1e-12 ? 2.0 * std::atan2(sine, q[0]) / sine : 2.0 / q[0];
  return factor * v;
}

/// Rotation matrix of a rotation vector [rad] (Rodrigues).
inline Eigen::Matrix3d from_rotation_vector(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle < 1e-300) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

/// Roll, pitch, yaw [rad] with R = Rz(yaw) Ry(pitch) Rx(roll), pitch in [-pi/2, pi/2].
inline Eigen::Vector3d to_roll_pitch_yaw(const Eigen::Matrix3d& R) {
  // Where roll and yaw turn about one axis, any roll will do, with what it leaves of R.
  const double roll = std::atan2(R(2, 1), R(2, 2));
  const Eigen::Matrix3d S = R * Eigen::AngleAxisd(-roll, Eigen::Vector3d::UnitX());
  return {roll, std::atan2(-S(2, 0), S(2, 2)), std::atan2(-S(0, 1), S(1, 1))};
}

}  // namespace iksel
