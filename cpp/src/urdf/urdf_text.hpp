// SPDX-License-Identifier: BSD-3-Clause
// The text of a URDF before urdfdom sees it: what is mended in it, which of its links hang
// together, and what is left out because kinematics do not need it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/message_text.hpp"
#include "iksel/dh.hpp"
#include "urdf/xml.hpp"

namespace iksel {

/// A number that is read back as the same.
inline std::string exact_text(double number) { return number_text(number, 17); }

inline std::string exact_text(const Eigen::Vector3d& v) {
  return exact_text(v.x()) + " " + exact_text(v.y()) + " " + exact_text(v.z());
}

/// Writes orientations by `quat_xyzw`, which are URDF's from version 1.1 on, as `rpy`. Such ones of
/// older files, or beside an rpy, stay as they are.
void replace_quaternions(XmlElement& robot);

/// Text for urdfdom with what kinematics need: links by name, and of joints what they join, where
/// and how they move. What urdfdom insists on beyond that, effort and velocity of a limit or the
/// limit itself, is there with zeros. A number may be infinite, and stands between any blanks.
/// Throws UrdfError for joints whose orientation is a quaternion that does not count.
std::string kinematic_text(const XmlElement& robot);

/// What to do about a document that is no URDF, by the name of its root; empty for <robot>.
std::string explain_root(const std::string& name);

/// Leaves the tree with `links` in the URDF and takes the others out.
///
/// Throws UrdfError where a link is the child of two joints, of which urdfdom keeps the last; where
/// joints close a circle, which urdfdom walks for ever and loses as memory; where two links are of
/// different trees; and where there are several trees and none of the links.
void keep_one_tree(XmlElement& robot, const std::vector<std::string>& links);

/// The first sign that a document is xacro which has to be expanded; empty if there is none.
std::string find_xacro(const XmlElement& root);

/// The URDF of a table of Denavit and Hartenberg's parameters. Throws InvalidArgumentError naming a
/// bad number, name or limit.
std::string urdf_of_dh(const DhTable& table);

}  // namespace iksel
