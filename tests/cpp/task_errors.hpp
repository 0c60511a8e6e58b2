// SPDX-License-Identifier: BSD-3-Clause
// The deviation of a pose from a target as the documentation of Task defines it, by quaternions:
// the library's own formulas (goal/task_space.hpp) are others.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>

namespace iksel_test {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// The axis of rotation whose width is unlike the other two's; -1: none.
inline int odd_axis(const iksel::Task& task) {
  double width[3];
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    width[i] = std::min(task.rotation_upper[k] - task.rotation_lower[k], 2 * M_PI);
  }
  if (width[0] == width[1] && width[1] == width[2]) return -1;
  const double apart[3] = {std::abs(width[1] - width[2]), std::abs(width[0] - width[2]),
                           std::abs(width[0] - width[1])};
  int odd = 0;
  for (int i = 1; i < 3; ++i) {
    if (apart[i] < apart[odd] || (apart[i] == apart[odd] && width[i] > width[odd])) odd = i;
  }
  return odd;
}

/// The rotation vector of a quaternion.
inline Eigen::Vector3d vector_of(Eigen::Quaterniond rotation) {
  if (rotation.w() < 0) rotation.coeffs() *= -1;
  const double sine = rotation.vec().norm();
  const double angle = 2 * std::atan2(sine, rotation.w());
  if (sine == 0) return Eigen::Vector3d::Zero();
  return angle / sine * rotation.vec();
}

/// [position; rotation] along the axes of the task, all six of them.
inline Vector6 task_deviation(const iksel::Task& task, const iksel::Pose& target,
                              const iksel::Pose& pose) {
  const bool in_tool = task.frame == iksel::TaskFrame::tool;
  const Eigen::Quaterniond to(target.linear());
  const Eigen::Quaterniond at(pose.linear());
  const Eigen::Vector3d p = pose.translation() - target.translation();
  const Eigen::Quaterniond E = in_tool ? to.conjugate() * at : at * to.conjugate();
  Eigen::Vector3d r = vector_of(E);
  const int axis = odd_axis(task);
  if (axis >= 0) {
    Eigen::Quaterniond twist(E.w(), 0, 0, 0);
    twist.vec()[axis] = E.vec()[axis];
    twist.normalize();
    r = vector_of(E * twist.conjugate());
    r[axis] = vector_of(twist)[axis];
  }
  Vector6 deviation;
  deviation << (in_tool ? Eigen::Vector3d(to.conjugate() * p) : p), r;
  return deviation;
}

/// What of a deviation lies outside of the task's bounds.
inline Vector6 outside_of(const iksel::Task& task, const Vector6& deviation) {
  Vector6 out;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double p = deviation[i];
    const double r = deviation[3 + i];
    out[i] = p - std::min(std::max(p, task.position_lower[k]), task.position_upper[k]);
    out[3 + i] = r - std::min(std::max(r, task.rotation_lower[k]), task.rotation_upper[k]);
  }
  return out;
}

}  // namespace iksel_test
