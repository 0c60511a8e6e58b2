// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/link_tree.hpp"

#include <map>
#include <utility>

#include "urdf/chain_spec.hpp"
#include "urdf/joint.hpp"
#include "urdf/parse.hpp"

namespace iksel {
LinkTree LinkTree::from_urdf_file(const std::filesystem::path& path, const std::string& link) {
  return read_with_path(path, [&](const std::string& xml) { return from_urdf_string(xml, link); });
}

LinkTree LinkTree::from_urdf_string(const std::string& xml, const std::string& link) {
  return explain_xacro(xml, [&] { return make_link_tree(*parse_urdf(xml, {link})); });
}

LinkTree make_link_tree(const urdf::ModelInterface& model) {
  LinkTree tree;
  tree.robot_name = model.getName();
  // Links, and how many joints that move are above them.
  std::vector<std::pair<const urdf::Link*, int>> next{{model.getRoot().get(), 0}};
  while (!next.empty()) {
    auto [link, moving] = next.back();
    next.pop_back();
    if (const auto& joint = link->parent_joint) {
      if (joint->type != urdf::Joint::FIXED) ++moving;
      tree.joints.push_back(
          {joint->name, joint_type_name(joint->type), joint->parent_link_name, link->name});
    }
    tree.links.push_back(link->name);
    if (link->child_links.empty()) tree.tips.push_back({link->name, moving});
    const auto& children = link->child_links;
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      next.emplace_back(child->get(), moving);
    }
  }
  return tree;
}

std::string LinkTree::draw() const {
  // Depth first means that a link's parent is the last one of those that are still open.
  std::vector<std::string> open{links.front()};
  std::string text = links.front();
  for (const LinkTreeJoint& joint : joints) {
    while (open.size() > 1 && open.back() != joint.parent_link) open.pop_back();
    text += "\n" + std::string(2 * open.size(), ' ') + joint.child_link + "  (" + joint.name +
            ", " + joint.type + ")";
    open.push_back(joint.child_link);
  }
  return text;
}

std::vector<LinkJoint> read_link_joints(const std::string& urdf_xml,
                                        const std::vector<MimicCurve>& mimic_curves) {
  const auto model = parse_urdf(urdf_xml);
  Motions known = check_mimic_curves(*model, mimic_curves);
  std::map<std::string, int> index;
  std::vector<LinkJoint> joints;
  for (const std::string& name : make_link_tree(*model).links) {
    const urdf::Link& link = *model->links_.at(name);
    LinkJoint joint;
    if (!joints.empty()) {
      joint = read_joint(*model, *link.parent_joint, known);
      joint.parent = index.at(link.parent_joint->parent_link_name);
    }
    index[name] = static_cast<int>(joints.size());
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace iksel
