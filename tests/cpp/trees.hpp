// SPDX-License-Identifier: BSD-3-Clause
// Robots with several tips for tests: built-in arms on a torso of a few joints.
#pragma once

#include <iksel/iksel.hpp>
#include <regex>
#include <string>

namespace iksel_test {

/// The links and joints of a URDF, their names prefixed.
inline std::string prefixed(const std::string& urdf, const std::string& prefix) {
  const std::regex comment("<!--[^]*?-->");
  const std::regex head("^[^]*<robot[^>]*>|</robot>[^]*$");
  const std::regex name("(name|link|joint)=\"");
  std::string text = std::regex_replace(urdf, comment, "");
  text = std::regex_replace(text, head, "");
  return std::regex_replace(text, name, "$1=\"" + prefix);
}

/// A joint that carries the link NAME_link; `motion` is its type and what else belongs into it.
inline std::string joint_text(const std::string& name, const std::string& parent,
                              const std::string& type, const std::string& origin,
                              const std::string& axis = "0 0 1",
                              const std::string& limit = "lower=\"-2\" upper=\"2\"",
                              const std::string& more = "") {
  return "<link name=\"" + name + "_link\"/><joint name=\"" + name + "\" type=\"" + type +
         "\"><parent link=\"" + parent + "\"/><child link=\"" + name + "_link\"/><origin " +
         origin + "/><axis xyz=\"" + axis + "\"/><limit " + limit +
         " effort=\"1\" velocity=\"1\"/>" + more + "</joint>";
}

/// A copy of an arm, its names prefixed, on a link.
inline std::string mounted(const iksel::Robot& arm, const std::string& prefix,
                           const std::string& on, const std::string& origin) {
  return prefixed(arm.urdf(), prefix) + "<joint name=\"" + prefix +
         "mount\" type=\"fixed\"><parent link=\"" + on + "\"/><child link=\"" + prefix +
         iksel::LinkTree::from_urdf_string(arm.urdf()).links.front() + "\"/><origin " + origin +
         "/></joint>";
}

inline std::string robot_text(const std::string& inside) {
  return "<?xml version=\"1.0\"?><robot name=\"tree\"><link name=\"base\"/>" + inside + "</robot>";
}

/// Two copies of an arm, left and right, on a torso that lifts and turns.
inline std::string two_arms_on_torso(const iksel::Robot& arm) {
  return robot_text(joint_text("lift", "base", "prismatic", "xyz=\"0 0 0.5\"", "0 0 1",
                               "lower=\"0\" upper=\"0.35\"") +
                    joint_text("turn", "lift_link", "revolute", "xyz=\"0 0 0.1\"", "0 0 1",
                               "lower=\"-1.5\" upper=\"1.5\"") +
                    mounted(arm, "l_", "turn_link", "xyz=\"0 0.2 0.2\" rpy=\"-0.8 0 0\"") +
                    mounted(arm, "r_", "turn_link", "xyz=\"0 -0.2 0.2\" rpy=\"0.8 0 0\""));
}

inline iksel::RobotOptions tips_of(const std::vector<std::string>& tip_links) {
  iksel::RobotOptions options;
  options.tip_links = tip_links;
  return options;
}

/// That robot, its tips those of the arms.
inline iksel::Robot two_armed(const iksel::Robot& arm) {
  return iksel::Robot::from_urdf_string(two_arms_on_torso(arm),
                                        tips_of({"l_" + arm.tip_link(), "r_" + arm.tip_link()}));
}

}  // namespace iksel_test
