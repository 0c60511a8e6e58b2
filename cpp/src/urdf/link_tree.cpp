// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/link_tree.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

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
  struct Visit {
    const urdf::Link* link;
    int moving_joints;
  };
  std::vector<Visit> next{{model.getRoot().get(), 0}};
  std::set<const urdf::Link*> seen{model.getRoot().get()};
  while (!next.empty()) {
    const auto [link, above] = next.back();
    next.pop_back();
    int moving = above;
    if (const auto& joint = link->parent_joint; joint && link->getParent()) {
      if (joint->type != urdf::Joint::FIXED) ++moving;
      tree.joints.push_back(
          {joint->name, joint_type_name(joint->type), joint->parent_link_name, link->name});
    }
    tree.links.push_back(link->name);
    if (link->child_links.empty()) tree.tips.push_back({link->name, moving});
    for (std::size_t i = link->child_links.size(); i-- > 0;) {
      // urdfdom takes the last of several parents, and keeps the link with each of them.
      const urdf::Link* child = link->child_links[i].get();
      if (child->getParent().get() == link && seen.insert(child).second) {
        next.push_back({child, moving});
      }
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

}  // namespace iksel
