// SPDX-License-Identifier: BSD-3-Clause
// The joints that carry the links of a whole URDF, on the chain or not.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "base/motion_curve.hpp"
#include "iksel/mimic_curve.hpp"

namespace iksel {

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

/// One for each link, in the order of LinkTree::links, where parents come first. Throws UrdfError
/// or UnknownNameError.
std::vector<LinkJoint> read_link_joints(const std::string& urdf_xml,
                                        const std::vector<MimicCurve>& mimic_curves);

}  // namespace iksel
