// SPDX-License-Identifier: BSD-3-Clause
// Poses of messages, of ROS 1 or 2.
#pragma once

#include <cmath>
#include <iksel/iksel.hpp>
#include <string>

namespace iksel_ros {

/// The pose that a message stands for. Throws InvalidArgumentError if its quaternion is not of
/// length 1 to about three digits.
template <class PoseMessage>
iksel::Pose to_pose(const PoseMessage& message) {
  const auto& o = message.orientation;
  const Eigen::Quaterniond rotation(o.w, o.x, o.y, o.z);
  // A message that nobody filled in has zeros, which would pass for no rotation.
  if (!(std::abs(rotation.norm() - 1) < iksel::kRigidTolerance)) {
    throw iksel::InvalidArgumentError("orientation: the quaternion has length " +
                                      std::to_string(rotation.norm()) + ", not 1");
  }
  iksel::Pose pose = iksel::Pose::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() << message.position.x, message.position.y, message.position.z;
  return pose;
}

}  // namespace iksel_ros
