// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics/link_poses.hpp"

#include <algorithm>
#include <cmath>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "kinematics/robot_model.hpp"

namespace iksel {
namespace {

using Values = std::map<std::string, double>;

/// Index of the degree of freedom that moves a joint; -1 if it is held.
int variable_of(const LinkJoint& joint, const RobotModel& model) {
  const Values& locked = model.options.locked_joints;
  if (!joint.moves || locked.count(joint.name) || locked.count(joint.source)) return -1;
  return model.joints.find(joint.source);
}

void check_other_joints(const RobotModel& model, const std::vector<LinkJoint>& joints,
                        const Values& other_joints) {
  for (const auto& [name, value] : other_joints) {
    const auto joint = std::find_if(joints.begin(), joints.end(),
                                    [&, &name = name](const auto& j) { return j.name == name; });
    if (name.empty() || joint == joints.end()) {
      std::vector<std::string> names;
      for (const LinkJoint& each : joints) {
        if (!each.name.empty()) names.push_back(each.name);
      }
      throw_unknown_name("other_joints: '" + name + "' is not in the URDF", name, names);
    }
    if (!(std::abs(value) <= kMaxCoordinate)) {
      throw InvalidArgumentError("other_joints: the value of '" + name + "' is " +
                                 too_large_text(value));
    }
    if (variable_of(*joint, model) < 0) continue;
    throw InvalidArgumentError("other_joints: '" + name + "' moves with q's joint '" +
                               joint->source + "'");
  }
}

/// The value of a joint that is held: its own, or what it follows from, or 0.
double held_value(const LinkJoint& joint, const Values& held) {
  const auto own = held.find(joint.name);
  if (own != held.end()) return own->second;
  const auto source = held.find(joint.source);
  return motion_of(joint, source == held.end() ? 0.0 : source->second);
}

}  // namespace

LinkPoses::LinkPoses(const RobotModel& model, const std::vector<LinkJoint>& joints,
                     const Values& other_joints) {
  check_other_joints(model, joints, other_joints);
  Values held = other_joints;
  held.insert(model.options.locked_joints.begin(), model.options.locked_joints.end());
  const auto& links = model.link_names;
  base_ = static_cast<std::size_t>(std::find(links.begin(), links.end(), model.options.base_link) -
                                   links.begin());
  for (const LinkJoint& joint : joints) {
    steps_.push_back({joint, variable_of(joint, model)});
    if (!joint.moves || steps_.back().variable >= 0) continue;
    steps_.back().joint.origin =
        moved(joint.origin, joint.axis, joint.prismatic, held_value(joint, held));
  }
}

void LinkPoses::at(const double* q, Pose* T_base_link) const {
  T_base_link[0] = Pose::Identity();
  for (std::size_t i = 1; i < steps_.size(); ++i) {
    const auto& [joint, variable] = steps_[i];
    const Pose& above = T_base_link[joint.parent];
    if (variable < 0) {
      T_base_link[i] = above * joint.origin;
    } else {
      const double value = motion_of(joint, q[variable]);
      T_base_link[i] = above * moved(joint.origin, joint.axis, joint.prismatic, value);
    }
  }
  if (base_ == 0) return;
  // So far they are in the root's frame.
  const Pose T_base_root = T_base_link[base_].inverse();
  for (std::size_t i = 0; i < steps_.size(); ++i) T_base_link[i] = T_base_root * T_base_link[i];
  T_base_link[base_] = Pose::Identity();
}

void LinkPoseCache::read(const RobotModel& model) {
  std::call_once(once_, [&] {
    joints_ = read_link_joints(model.urdf, model.options.mimic_curves);
    plain_ = std::make_unique<const LinkPoses>(model, joints_, Values{});
  });
}

}  // namespace iksel
