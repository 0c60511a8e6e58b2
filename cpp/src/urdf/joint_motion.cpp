// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/joint_motion.hpp"

#include <cmath>
#include <string>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/types.hpp"
#include "urdf/parse.hpp"

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

Motion resolve_mimic(const urdf::ModelInterface& model, const urdf::Joint& joint) {
  Motion motion{&joint, 1.0, 0.0};
  for (std::size_t steps = 0; motion.source->mimic; ++steps) {
    const urdf::JointMimic& mimic = *motion.source->mimic;
    const auto it = model.joints_.find(mimic.joint_name);
    if (it == model.joints_.end()) {
      throw_unknown_name("joint '" + motion.source->name + "' mimics '" + mimic.joint_name +
                             "', which is not in the URDF",
                         mimic.joint_name, joint_names_of(model));
    }
    if (steps > model.joints_.size()) {
      throw UrdfError("joint '" + joint.name + "' mimics itself through a circle of joints");
    }
    motion = {it->second.get(), motion.multiplier * mimic.multiplier,
              motion.offset + motion.multiplier * mimic.offset};
  }
  for (const double number : {motion.multiplier, motion.offset}) {
    if (std::abs(number) <= kMaxCoordinate) continue;
    throw UrdfError("joint '" + joint.name + "': its mimic multiplier or offset is " +
                    too_large_text(number));
  }
  const auto type = motion.source->type;
  if (type != urdf::Joint::REVOLUTE && type != urdf::Joint::CONTINUOUS &&
      type != urdf::Joint::PRISMATIC) {
    throw UrdfError("joint '" + joint.name + "' mimics '" + motion.source->name + "', which is " +
                    joint_type_name(type));
  }
  return motion;
}

}  // namespace iksel
