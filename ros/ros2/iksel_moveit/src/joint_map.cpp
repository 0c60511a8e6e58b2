// SPDX-License-Identifier: BSD-3-Clause
#include "joint_map.hpp"

#include <algorithm>

#include "moveit_headers.hpp"

namespace iksel_moveit {

JointMap::JointMap(const moveit::core::JointModelGroup& group) {
  std::vector<const moveit::core::JointModel*> moving;
  for (const moveit::core::JointModel* joint : group.getJointModels()) {
    if (joint->getVariableCount() == 1) {
      moving.push_back(joint);
      names_.push_back(joint->getName());
    }
  }
  for (const moveit::core::JointModel* joint : moving) {
    if (joint->getMimic() == nullptr) continue;
    mimics_.push_back({index(joint->getName()), index(joint->getMimic()->getName()),
                       joint->getMimicFactor(), joint->getMimicOffset()});
  }
}

std::size_t JointMap::index(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) {
    throw iksel::UnknownNameError("joint '" + name + "' is not in the group", names_);
  }
  return static_cast<std::size_t>(found - names_.begin());
}

iksel::JointVector JointMap::pick(const iksel::Robot& robot,
                                  const std::vector<double>& values) const {
  iksel::JointVector q(robot.dof());
  for (int i = 0; i < robot.dof(); ++i) {
    q[i] = values[index(robot.joint_names()[static_cast<std::size_t>(i)])];
  }
  return q;
}

void JointMap::spread(const iksel::Robot& robot, const double* q,
                      std::vector<double>& values) const {
  for (int i = 0; i < robot.dof(); ++i) {
    values[index(robot.joint_names()[static_cast<std::size_t>(i)])] = q[i];
  }
  for (const Mimic& mimic : mimics_) {
    values[mimic.joint] = mimic.factor * values[mimic.followed] + mimic.offset;
  }
}

}  // namespace iksel_moveit
