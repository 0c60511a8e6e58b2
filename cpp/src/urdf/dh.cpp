// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "base/rotation.hpp"
#include "iksel/error.hpp"
#include "iksel/pose.hpp"
#include "urdf/urdf_text.hpp"

namespace iksel {
namespace {

/// A joint, and the link that it carries. `inside`: further elements.
std::string joint_element(const std::string& name, const char* type, const std::string& parent,
                          const std::string& child, const Eigen::Vector3d& xyz,
                          const Eigen::Vector3d& rpy, const std::string& inside = "") {
  return "  <link name=\"" + child + "\"/>\n  <joint name=\"" + escape_xml(name) + "\" type=\"" +
         type + "\">\n    <parent link=\"" + parent + "\"/>\n    <child link=\"" + child +
         "\"/>\n    <origin xyz=\"" + exact_text(xyz) + "\" rpy=\"" + exact_text(rpy) + "\"/>\n" +
         inside + "  </joint>\n";
}

void check_row(const DhJoint& row, std::ptrdiff_t i) {
  for (const double number : {row.a, row.alpha, row.d, row.theta}) {
    if (!std::isfinite(number)) {
      throw_invalid("joints", i, "a, alpha, d or theta is " + number_text(number));
    }
  }
  if (!(row.velocity >= 0)) {
    throw_invalid("joints", i, "velocity is " + number_text(row.velocity) + ", not 0 or more");
  }
  const bool is_limited = std::isfinite(row.lower) && std::isfinite(row.upper);
  if (!is_limited && !(row.lower == -kInfinity && row.upper == kInfinity)) {
    throw_invalid("joints", i,
                  "limits " + number_text(row.lower) + " to " + number_text(row.upper) +
                      ": give both, or none");
  }
  if (row.type == JointType::prismatic && !is_limited) {
    throw_invalid("joints", i, "a prismatic joint needs limits: give lower and upper [m]");
  }
  if (row.type == JointType::continuous && is_limited) {
    throw_invalid("joints", i, "a continuous joint has no limits; a revolute one has");
  }
}

/// The joint itself, which moves about or along z.
std::string moving(const DhJoint& row, const std::string& name, const std::string& parent,
                   const std::string& child) {
  const bool slides = row.type == JointType::prismatic;
  const bool is_limited = std::isfinite(row.lower);
  const char* type = slides ? "prismatic" : is_limited ? "revolute" : "continuous";
  std::string inside = "    <axis xyz=\"0 0 1\"/>\n    <limit effort=\"0\" velocity=\"" +
                       exact_text(std::isfinite(row.velocity) ? row.velocity : 0.0) + "\"";
  if (is_limited) {
    inside += " lower=\"" + exact_text(row.lower) + "\" upper=\"" + exact_text(row.upper) + "\"";
  }
  return joint_element(name, type, parent, child, {0, 0, row.d}, {0, 0, row.theta},
                       inside + "/>\n");
}

std::string fixed(const std::string& parent, const std::string& child, const Eigen::Vector3d& xyz,
                  const Eigen::Vector3d& rpy) {
  return joint_element(child + "_fixed", "fixed", parent, child, xyz, rpy);
}

}  // namespace

std::string urdf_of_dh(const DhTable& table) {
  if (table.joints.empty()) throw InvalidArgumentError("joints: a table has one row or more");
  const Pose base = check_pose(table.T_base_link0, "base");
  std::string text = "<robot name=\"" + escape_xml(table.robot_name) +
                     "\">\n  <link name=\"base\"/>\n" +
                     fixed("base", "link0", base.translation(), to_roll_pitch_yaw(base.linear()));
  std::set<std::string> names;
  for (std::size_t i = 0; i < table.joints.size(); ++i) {
    const DhJoint& row = table.joints[i];
    const auto index = static_cast<std::ptrdiff_t>(i);
    check_row(row, index);
    const std::string number = std::to_string(i + 1);
    const std::string name = row.name.empty() ? "joint" + number : row.name;
    if (!names.insert(name).second) throw_invalid("joints", index, "a second '" + name + "'");
    const std::string before = "link" + std::to_string(i);
    const std::string between = "axis" + number;
    const std::string link = "link" + number;
    const Eigen::Vector3d xyz(row.a, 0, 0);
    const Eigen::Vector3d rpy(row.alpha, 0, 0);
    text += table.convention == DhConvention::standard
                ? moving(row, name, before, between) + fixed(between, link, xyz, rpy)
                : fixed(before, between, xyz, rpy) + moving(row, name, between, link);
  }
  return text + "</robot>\n";
}

}  // namespace iksel
