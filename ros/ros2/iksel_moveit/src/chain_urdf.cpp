// SPDX-License-Identifier: BSD-3-Clause
#include "chain_urdf.hpp"

#include <iksel/iksel.hpp>
#include <limits>
#include <locale>
#include <sstream>

#include "moveit_headers.hpp"

namespace iksel_moveit {
namespace {

using moveit::core::JointModel;
using moveit::core::LinkModel;

// Numbers come back as they were, whatever the locale.
std::ostringstream exact_text() {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(std::numeric_limits<double>::max_digits10);
  return text;
}

std::string triple(const Eigen::Vector3d& v) {
  std::ostringstream text = exact_text();
  text << v.x() << ' ' << v.y() << ' ' << v.z();
  return text.str();
}

std::string type_of(const JointModel& joint) {
  switch (joint.getType()) {
    case JointModel::FIXED:
      return "fixed";
    case JointModel::PRISMATIC:
      return "prismatic";
    case JointModel::REVOLUTE:
      return joint.getVariableBounds().front().position_bounded_ ? "revolute" : "continuous";
    default:
      throw iksel::UrdfError("joint '" + joint.getName() + "' is " + joint.getTypeName() +
                             ": not revolute, prismatic or fixed");
  }
}

Eigen::Vector3d axis_of(const JointModel& joint) {
  if (joint.getType() == JointModel::PRISMATIC) {
    return static_cast<const moveit::core::PrismaticJointModel&>(joint).getAxis();
  }
  return static_cast<const moveit::core::RevoluteJointModel&>(joint).getAxis();
}

void write_motion(const JointModel& joint, std::ostream& out) {
  out << "<axis xyz=\"" << triple(axis_of(joint)) << "\"/>";
  const moveit::core::VariableBounds& bounds = joint.getVariableBounds().front();
  out << "<limit effort=\"0\" velocity=\"" << (bounds.velocity_bounded_ ? bounds.max_velocity_ : 0)
      << '"';
  if (bounds.position_bounded_) {
    out << " lower=\"" << bounds.min_position_ << "\" upper=\"" << bounds.max_position_ << '"';
  }
  out << "/>";
  if (joint.getMimic() != nullptr) {
    out << "<mimic joint=\"" << joint.getMimic()->getName() << "\" multiplier=\""
        << joint.getMimicFactor() << "\" offset=\"" << joint.getMimicOffset() << "\"/>";
  }
}

void write_joint(const LinkModel& child, std::ostream& out) {
  const JointModel& joint = *child.getParentJointModel();
  const Eigen::Isometry3d& origin = child.getJointOriginTransform();
  // URDF's fixed axes: R = Rz(yaw) Ry(pitch) Rx(roll).
  const Eigen::Vector3d ypr = origin.linear().eulerAngles(2, 1, 0);
  out << "<joint name=\"" << joint.getName() << "\" type=\"" << type_of(joint) << "\">"
      << "<parent link=\"" << child.getParentLinkModel()->getName() << "\"/>"
      << "<child link=\"" << child.getName() << "\"/>"
      << "<origin xyz=\"" << triple(origin.translation()) << "\" rpy=\"" << triple(ypr.reverse())
      << "\"/>";
  if (joint.getType() != JointModel::FIXED) write_motion(joint, out);
  out << "</joint>";
}

}  // namespace

std::string chain_urdf(const moveit::core::RobotModel& model, const std::string& base,
                       const std::string& tip) {
  for (const std::string& name : {base, tip}) {
    if (!model.hasLinkModel(name)) {
      throw iksel::UnknownNameError("there is no link '" + name + "'", model.getLinkModelNames());
    }
  }
  std::ostringstream out = exact_text();
  out << "<robot name=\"" << model.getName() << "\">";
  const LinkModel* link = model.getLinkModel(tip);
  for (; link != nullptr && link->getName() != base; link = link->getParentLinkModel()) {
    out << "<link name=\"" << link->getName() << "\"/>";
    if (link->getParentLinkModel() != nullptr) write_joint(*link, out);
  }
  if (link == nullptr) {
    throw iksel::UrdfError("link '" + tip + "' does not hang on link '" + base + "'");
  }
  out << "<link name=\"" << base << "\"/></robot>";
  return out.str();
}

}  // namespace iksel_moveit
