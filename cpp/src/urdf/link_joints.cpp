// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/link_joints.hpp"

#include <map>

#include "urdf/joint.hpp"
#include "urdf/parse.hpp"

namespace iksel {
namespace {

LinkJoint make_link_joint(const urdf::ModelInterface& model, const CheckedCurves& curves,
                          const urdf::Joint& joint) {
  LinkJoint out;
  out.name = out.source = joint.name;
  out.origin = origin_of(joint);
  out.prismatic = joint.type == urdf::Joint::PRISMATIC;
  out.moves =
      out.prismatic || joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS;
  if (!out.moves) return out;
  out.axis = axis_of(joint);
  const Motion motion = resolve_mimic(model, curves, joint);
  out.source = motion.source->name;
  static_cast<Following&>(out) = motion;
  return out;
}

}  // namespace

std::vector<LinkJoint> read_link_joints(const std::string& urdf_xml,
                                        const std::vector<MimicCurve>& mimic_curves) {
  const auto model = parse_urdf(urdf_xml);
  const CheckedCurves curves = check_mimic_curves(*model, mimic_curves);
  std::map<std::string, int> index;
  std::vector<LinkJoint> joints;
  for (const std::string& name : make_link_tree(*model).links) {
    const urdf::Link& link = *model->links_.at(name);
    LinkJoint joint;
    if (!joints.empty()) {
      joint = make_link_joint(*model, curves, *link.parent_joint);
      joint.parent = index.at(link.parent_joint->parent_link_name);
    }
    index[name] = static_cast<int>(joints.size());
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace iksel
