// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/joint_frame.hpp"

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/types.hpp"

namespace iksel {

Eigen::Isometry3d origin_of(const urdf::Joint& joint) {
  const urdf::Pose& pose = joint.parent_to_joint_origin_transform;
  const urdf::Rotation& r = pose.rotation;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  T.translation() << pose.position.x, pose.position.y, pose.position.z;
  if (!T.matrix().allFinite()) {
    throw UrdfError("joint '" + joint.name + "': its origin is not finite");
  }
  return T;
}

Eigen::Vector3d axis_of(const urdf::Joint& joint) {
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (!(axis.norm() >= 1e-9 && axis.norm() <= kMaxCoordinate)) {
    throw UrdfError("joint '" + joint.name + "' has no axis: its axis vector has the length " +
                    number_text(axis.norm()));
  }
  return axis.normalized();
}

}  // namespace iksel
