// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/urdf_text.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <locale>
#include <sstream>

#include "base/rotation.hpp"
#include "iksel/error.hpp"
#include "iksel/urdf_text.hpp"

namespace iksel {
namespace {

/// An element of a joint that kinematics need, and its attributes.
struct Part {
  const char* name;
  std::vector<const char*> names;    ///< attributes that are names
  std::vector<const char*> numbers;  ///< attributes that are numbers
  std::vector<const char*> limits;   ///< attributes that are numbers, and may be infinite
};

const std::vector<Part>& joint_parts() {
  static const std::vector<Part> kParts = {
      {"parent", {"link"}, {}, {}},
      {"child", {"link"}, {}, {}},
      {"origin", {}, {"xyz", "rpy"}, {}},
      {"axis", {}, {"xyz"}, {}},
      {"limit", {}, {}, {"lower", "upper", "velocity"}},
      {"mimic", {"joint"}, {"multiplier", "offset"}, {}},
      {"safety_controller", {}, {}, {"soft_lower_limit", "soft_upper_limit"}},
  };
  return kParts;
}

/// Numbers as urdfdom reads them, with one space between them.
std::string plain_numbers(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  std::string plain;
  for (std::string word; in >> word;) plain += (plain.empty() ? "" : " ") + word;
  return plain;
}

/// A limit as urdfdom reads it. Infinity, which it does not know, is the largest number.
std::string plain_limit(const std::string& text) {
  std::string number = plain_numbers(text);
  const std::string size = lower_case(number.substr(number.find_first_not_of("+-") == 1 ? 1 : 0));
  if (size != "inf" && size != "infinity") return number;
  return number[0] == '-' ? "-1e308" : "1e308";
}

void copy_attributes(const XmlElement& from, const Part& part, XmlElement& to) {
  const auto copy = [&](const std::vector<const char*>& keys, const auto& written) {
    for (const char* key : keys) {
      const std::string value = written(from.value(key));
      // As if those without anything in them were not there.
      if (!value.empty()) to.attributes.emplace_back(key, value);
    }
  };
  copy(part.names, [](const std::string& name) { return name; });
  copy(part.numbers, plain_numbers);
  copy(part.limits, plain_limit);
}

void add_missing(XmlElement& element, const char* key, const char* value) {
  if (element.attribute(key) == nullptr) element.attributes.emplace_back(key, value);
}

XmlElement kinematic_joint(const XmlElement& joint) {
  XmlElement made;
  made.name = "joint";
  copy_attributes(joint, {"joint", {"name", "type"}, {}, {}}, made);
  const std::string type = joint.value("type");
  for (const Part& part : joint_parts()) {
    const XmlElement* given = joint.child(part.name);
    const bool is_limit = part.name == std::string("limit");
    if (!given && !(is_limit && (type == "revolute" || type == "prismatic"))) continue;
    XmlElement& element = made.children.emplace_back();
    element.name = part.name;
    if (given != nullptr) copy_attributes(*given, part, element);
    if (is_limit) {
      add_missing(element, "effort", "0");
      add_missing(element, "velocity", "0");
    }
    if (part.name == std::string("safety_controller")) add_missing(element, "k_velocity", "0");
  }
  return made;
}

/// The number of a version "1.2", in tenths; 10 where there is none.
int version_of(const XmlElement& robot) {
  std::istringstream in(robot.value("version"));
  in.imbue(std::locale::classic());
  int major = 0;
  int minor = 0;
  char dot = 0;
  if (!(in >> major >> dot >> minor) || dot != '.') return 10;
  return major > 1 ? 20 : 10 * major + std::min(minor, 9);
}

/// Roll, pitch and yaw of a quaternion x y z w; empty where that is none.
std::string rpy_of(const std::string& quaternion) {
  std::istringstream in(quaternion);
  in.imbue(std::locale::classic());
  Eigen::Quaterniond turn;
  std::string more;
  if (!(in >> turn.x() >> turn.y() >> turn.z() >> turn.w()) || in >> more) return "";
  if (!(turn.norm() > 1e-9 && turn.norm() < 1e9)) return "";
  return exact_text(to_roll_pitch_yaw(turn.normalized().toRotationMatrix()));
}

void replace_quaternions_in(XmlElement& element) {
  if (element.name == "origin" && element.attribute("rpy") == nullptr) {
    for (auto& [name, value] : element.attributes) {
      const std::string rpy = name == "quat_xyzw" ? rpy_of(value) : "";
      if (rpy.empty()) continue;
      name = "rpy";
      value = rpy;
    }
  }
  for (XmlElement& child : element.children) replace_quaternions_in(child);
}

void check_orientation(const XmlElement& joint, int version) {
  const XmlElement* origin = joint.child("origin");
  const std::string* quaternion = origin == nullptr ? nullptr : origin->attribute("quat_xyzw");
  if (quaternion == nullptr) return;
  const std::string culprit = "joint '" + joint.value("name") + "': its origin has ";
  if (origin->attribute("rpy") != nullptr) {
    throw UrdfError(culprit + "both rpy and quat_xyzw: take one of them out");
  }
  if (version <= 10) {
    throw UrdfError(culprit +
                    "quat_xyzw, which URDF knows from version 1.1 on: write <robot "
                    "version=\"1.1\">, or rpy in its place");
  }
  throw UrdfError(culprit + "quat_xyzw=\"" + *quaternion +
                  "\", expected four numbers, x y z w, that are not all 0");
}

}  // namespace

void replace_quaternions(XmlElement& robot) {
  if (robot.name == "robot" && version_of(robot) > 10) replace_quaternions_in(robot);
}

std::string kinematic_text(const XmlElement& robot) {
  XmlElement made;
  made.name = "robot";
  made.attributes.emplace_back("name", robot.value("name"));
  for (const XmlElement& element : robot.children) {
    if (element.name == "link") {
      XmlElement& link = made.children.emplace_back();
      link.name = element.name;
      copy_attributes(element, {"link", {"name"}, {}, {}}, link);
    } else if (element.name == "joint") {
      check_orientation(element, version_of(robot));
      made.children.push_back(kinematic_joint(element));
    }
  }
  return write_xml(made);
}

std::string explain_root(const std::string& name) {
  if (name.empty() || name == "robot") return "";
  const std::string is = "its first element is <" + name + ">, where a URDF has <robot>";
  if (name == "html" || name == "HTML") {
    return is + ": it is a web page; download the file itself (on GitHub by the button Raw)";
  }
  if (name == "sdf" || name == "gazebo" || name == "world" || name == "model") {
    return is +
           ": it is SDF; give the URDF or xacro that it was made from, or convert it, as "
           "ROS's sdformat_urdf does";
  }
  if (name == "mujoco") return is + ": it is MJCF; give its path to iksel.load_robot in Python";
  if (name == "COLLADA") return is + ": it is a mesh; give the URDF that names it";
  return is + " (in small letters, without a prefix)";
}

std::string find_xacro(const XmlElement& root) {
  const bool is_declared = root.attribute("xmlns:xacro") != nullptr;
  std::vector<const XmlElement*> next{&root};
  while (!next.empty()) {
    const XmlElement& element = *next.back();
    next.pop_back();
    if (element.name.compare(0, 6, "xacro:") == 0) return "<" + element.name + ">";
    for (const auto& [name, value] : element.attributes) {
      const std::size_t at = std::min(value.find("${"), value.find("$("));
      if (is_declared && at != std::string::npos) return value.substr(at, 20);
    }
    for (auto child = element.children.rbegin(); child != element.children.rend(); ++child) {
      next.push_back(&*child);
    }
  }
  return "";
}

std::string mend_xml(const std::string& bytes, const std::string& link) {
  XmlElement root = parse_xml(bytes);
  if (!link.empty()) keep_one_tree(root, {link});
  replace_quaternions(root);
  return write_xml(root);
}

}  // namespace iksel
