// SPDX-License-Identifier: BSD-3-Clause
// What the URDF says of a chain, and of the links beside it, joint by joint, before any kinematics
// is made of it.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "base/motion_curve.hpp"
#include "iksel/robot_options.hpp"

namespace iksel {

/// One joint on the way from base to tip: first the constant transform `before`, then the motion by
/// motion_of(joint, q[variable]) (base/motion_curve.hpp) about or along `axis`, then `after`. A
/// fixed or locked joint has the constant transforms only.
struct ChainJoint : Following {
  std::string name;
  std::string link;  ///< that it leads to on the way to the tip
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d after = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  bool fixed = false;
  bool is_locked = false;  ///< fixed, where it would move
  double locked_at = 0;    ///< then the joint's value [rad or m]
  bool prismatic = false;
  int variable = -1;  ///< -1: fixed

  /// Whether limits may name it: one that moves, or would.
  [[nodiscard]] bool has_value() const { return !fixed || is_locked; }
};

/// T, and then a motion by `value` along or about `axis`.
inline Eigen::Isometry3d moved(Eigen::Isometry3d T, const Eigen::Vector3d& axis, bool prismatic,
                               double value) {
  if (prismatic) {
    T.translate(value * axis);
  } else {
    T.rotate(Eigen::AngleAxisd(value, axis));
  }
  return T;
}

/// One degree of freedom.
struct ChainVariable {
  std::string name;
  JointType type = JointType::revolute;
  double lower = 0, upper = 0;
  double soft_lower = 0, soft_upper = 0;
  double velocity = 0;
};

struct ChainSpec {
  std::string robot_name;
  std::vector<std::string> link_names;  ///< of the whole URDF
  std::vector<ChainJoint> joints;
  std::vector<ChainVariable> variables;
};

/// The joint that carries a link. Its pose in the parent link is `origin`, then the motion about or
/// along `axis` by its value, which is motion_of (base/motion_curve.hpp) that of `source`.
struct LinkJoint : Following {
  std::string name;  ///< empty: the root link, which nothing carries
  int parent = -1;   ///< index of the link that it is on
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  bool moves = false;  ///< revolute, continuous or prismatic
  bool prismatic = false;
  std::string source;  ///< the joint that it follows in the end, or itself
};

/// Reads the chain that `options` choose; fills in their base and tip link where they are empty.
ChainSpec read_chain(const std::string& urdf_xml, RobotOptions& options);

/// One for each link, in the order of LinkTree::links, where parents come first. Throws UrdfError
/// or UnknownNameError.
std::vector<LinkJoint> read_link_joints(const std::string& urdf_xml,
                                        const std::vector<MimicCurve>& mimic_curves);

}  // namespace iksel
