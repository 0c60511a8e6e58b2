// SPDX-License-Identifier: BSD-3-Clause
// The deviation of a pose from a target, part by part as a Task bounds it, and its Jacobian.
//
// Rotations as swing and twist: with E = S T(tau) about the axis a, u = E a = S a is where the
// tool's a points, phi the angle from a to u, n the axis a x u / sin(phi) and m = n x a. The swing
// vector is phi n. For an angular velocity w (E' = [w] E) with parts w_a, w_m, w_n along these,
//   (phi n)' = n w_n + m phi (w_m cot(phi) - w_a),   tau' = w_a + w_m tan(phi / 2),
// which follows from u' = w x u and, for tau', from what w leaves along u when the velocity of the
// least rotation S is taken off.
#pragma once

#include <algorithm>
#include <limits>

#include "base/constants.hpp"
#include "base/pseudo_inverse.hpp"
#include "iksel/task.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// Squared error that counts as far off while a seed is iterated [rad and units].
inline constexpr double kFarOff2 = 1e-4;

/// |v|, of a target that is so far away that squares overflow too; of one farther still the largest
/// double.
inline double length_of(const Eigen::Vector3d& v) {
  const double length = v.norm();
  return length < kInfinity ? length : std::min(v.stableNorm(), std::numeric_limits<double>::max());
}

/// A task as the iterations use it.
class TaskSpace {
 public:
  TaskSpace() : TaskSpace(Task{}, 0, 0) {}
  /// The tolerances are the solver's [m, rad].
  TaskSpace(const Task& task, double position_tolerance, double rotation_tolerance);

  [[nodiscard]] const Task& task() const { return task_; }
  [[nodiscard]] double position_tolerance() const { return position_tolerance_; }
  [[nodiscard]] double rotation_tolerance() const { return rotation_tolerance_; }
  [[nodiscard]] bool is_full_pose() const { return full_pose_; }
  [[nodiscard]] int constrained_axes() const { return task_.constrained_axes(); }
  /// Number of axes without any width: a chain with more joints has families of solutions.
  [[nodiscard]] int fixed_axes() const {
    return static_cast<int>((lower_.array() == upper_.array()).count());
  }
  [[nodiscard]] bool rotation_is_free() const { return rotation_free_; }
  /// Axis of the twist; -1: the rotation vector is used.
  [[nodiscard]] int twist_axis() const { return twist_; }

  /// Bounds of the deviation, and those that iterations aim at: narrower by the tolerances where
  /// there is room, so that answers end inside.
  [[nodiscard]] const Vector6& lower() const { return lower_; }
  [[nodiscard]] const Vector6& upper() const { return upper_; }
  [[nodiscard]] const Vector6& aim_lower() const { return aim_lower_; }
  [[nodiscard]] const Vector6& aim_upper() const { return aim_upper_; }

  /// Weights of the axes, with 0 for those that are free to both sides.
  [[nodiscard]] Vector6 without_free(const Vector6& weights) const {
    return (lower_.array().isInf() && upper_.array().isInf()).select(0, weights);
  }

  /// [position; rotation] deviation of a TCP pose along the axes of the task; the rotation's is
  /// zero where all of it is free.
  [[nodiscard]] Vector6 deviation(const Pose& target, const Pose& pose) const;
  /// As above; also turns the Jacobian of the pose (twists in base axes) into the deviation's.
  Vector6 deviation(const Pose& target, const Pose& pose, JacobianMatrix& jacobian) const;

  /// A pose whose deviation is `deviation`; the inverse of the above.
  [[nodiscard]] Pose pose_at(const Pose& target, const Vector6& deviation) const;

  /// The part of a deviation that lies outside of the bounds.
  [[nodiscard]] Vector6 outside(const Vector6& deviation) const {
    return deviation - deviation.cwiseMax(lower_).cwiseMin(upper_);
  }
  /// What is missing from a deviation to the bounds that iterations aim at.
  [[nodiscard]] Vector6 missing(const Vector6& deviation) const {
    return deviation.cwiseMax(aim_lower_).cwiseMin(aim_upper_) - deviation;
  }
  /// Whether what is missing of a deviation is less than that part of the tolerances.
  [[nodiscard]] bool is_reached(const Vector6& missing, double part) const {
    return missing.head<3>().norm() < part * position_tolerance_ &&
           missing.tail<3>().norm() < part * rotation_tolerance_;
  }
  /// Distances of a TCP pose from the box: position [m] and rotation [rad].
  void measure(const Pose& target, const Pose& pose, double& position, double& rotation) const;

  /// Least distance of the allowed positions from a point in the base frame [m].
  [[nodiscard]] double distance_from(const Pose& target, const Eigen::Vector3d& point) const;

 private:
  Eigen::Vector3d rotation_part(const Eigen::Matrix3d& E, Eigen::Matrix3d* map) const;

  Task task_;
  double position_tolerance_, rotation_tolerance_;
  bool full_pose_;
  int twist_ = -1;
  bool rotation_free_ = false;
  Vector6 lower_, upper_, aim_lower_, aim_upper_;
};

}  // namespace iksel
