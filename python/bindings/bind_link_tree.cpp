// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "urdf_source.hpp"

namespace iksel::python {

template <>
struct FieldTable<LinkTreeJoint> : HeaderTable<LinkTreeJoint> {};

namespace {

using Tips = std::vector<std::pair<std::string, int>>;

LinkTree tree_from_urdf(const UrdfSource& path_or_xml, const std::optional<std::string>& link) {
  const std::string name = link.value_or("");
  return read_urdf(
      path_or_xml, [&](const std::string& xml) { return LinkTree::from_urdf_string(xml, name); },
      [&](const std::filesystem::path& path) { return LinkTree::from_urdf_file(path, name); });
}

Tips tips_of(const LinkTree& self) {
  Tips tips;
  for (const auto& [link, moving] : self.tips) tips.emplace_back(link, moving);
  return tips;
}

/// Joint after joint, each leading to the next link.
py::dict tree_state(const LinkTree& self) {
  return py::dict("robot_name"_a = self.robot_name, "root"_a = self.links.front(),
                  "joints"_a = self.joints, "tips"_a = tips_of(self));
}

LinkTree tree_from_state(const std::string& robot_name, const std::string& root,
                         const std::vector<LinkTreeJoint>& joints, const py::object& tips) {
  LinkTree tree;
  tree.robot_name = robot_name;
  tree.links = {root};
  tree.joints = joints;
  for (const LinkTreeJoint& joint : joints) tree.links.push_back(joint.child_link);
  const std::string name = "pickled LinkTree, tips";
  if (!py::isinstance<py::list>(tips)) throw_wrong_type(name, "a list", tips);
  for (const py::handle tip : tips) {
    if (!py::isinstance<py::tuple>(tip) || py::len(tip) != 2) throw_wrong_type(name, "pairs", tip);
    const auto pair = py::reinterpret_borrow<py::tuple>(tip);
    const auto moving = from_python<int>(pair[1], name.c_str());
    is_count(moving, name);
    tree.tips.push_back({from_python<std::string>(pair[0], name.c_str()), moving});
  }
  return tree;
}

}  // namespace

void bind_link_tree(py::module_& m) {
  def(m, "mend_xml", "data, link=''",
      [](const py::bytes& data, const std::string& link) { return mend_xml(data, link); });
  bind_fields<LinkTreeJoint>(m, "LinkTree.from_urdf(path_or_xml).joints");
  auto tree = bind_class<LinkTree>(m, "LinkTree", "LinkTree.from_urdf(path_or_xml)");
  def_static(tree, "from_urdf", "path_or_xml, link=None", fn<&tree_from_urdf>,
             R"(Reads the tree of a URDF.

Args:
    path_or_xml: a path, or the URDF itself: a str whose first character is '<', or bytes.
    link: a link of the tree that is meant, where the links hang in several.

Raises:
    UrdfError: the file or the XML is no good, or there are several trees.)");
  add_properties(tree, "robot_name", &LinkTree::robot_name, "links", &LinkTree::links, "joints",
                 &LinkTree::joints);
  add_property(tree, "tips", &tips_of,
               "The links without children, each with the number of joints that move it.");
  def(tree, "__str__", "", fn<&LinkTree::draw>);
  def_repr(tree);
  def_pickle(tree, fn<&tree_state>, "robot_name, root, joints, tips", fn<&tree_from_state>);
}

}  // namespace iksel::python
