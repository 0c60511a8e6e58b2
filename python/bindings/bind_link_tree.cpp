// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "array_fields.hpp"
#include "bindings.hpp"
#include "iksel/link_tree.hpp"
#include "iksel/urdf_text.hpp"
#include "urdf_source.hpp"

namespace iksel::python {

template <>
struct FieldTable<LinkTreeJoint> {
  using J = LinkTreeJoint;
  static constexpr const char* kName = "LinkTreeJoint";
  static constexpr const char* kDoc = "One joint of a URDF.";
  static std::vector<Field> fields() {
    return {field("name", &J::name, "Its name."),
            field("type", &J::type, "'revolute', 'fixed', ..."),
            field("parent_link", &J::parent_link, "The link that it is on."),
            field("child_link", &J::child_link, "The link that it carries.")};
  }
};

namespace {

using Tips = std::vector<std::pair<std::string, int>>;

LinkTree tree_from_urdf(const UrdfSource& path_or_xml, const std::optional<std::string>& link) {
  const std::string name = link.value_or("");
  return read_urdf(
      path_or_xml, [&](const std::string& xml) { return LinkTree::from_urdf_string(xml, name); },
      [&](const std::filesystem::path& path) { return LinkTree::from_urdf_file(path, name); });
}

std::string tree_repr(const LinkTree& self) {
  return "LinkTree(" + repr_text(py::str(self.robot_name)) + ", " +
         std::to_string(self.links.size()) + " links, " + std::to_string(self.tips.size()) +
         " tips)";
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
  def(
      m, "mend_xml", "data, link=''",
      [](const py::bytes& data, const std::string& link) { return mend_xml(data, link); },
      R"(The text of an XML file (URDF, SRDF, MJCF) as every XML reader takes it.

It is UTF-8, with what people and exporters get wrong mended where it is clear what is meant; a DOCTYPE,
comments and a default namespace are left out, and quat_xyzw of URDF 1.1 becomes rpy.

Args:
    data: the bytes of the file.
    link: of a URDF whose links hang in several trees, the one of this link is left.

Raises:
    UrdfError: it is not clear what is meant; the message says the line.)");
  auto joint = bind_fields<LinkTreeJoint>(m, "LinkTree.from_urdf(path_or_xml).joints");
  def(joint, "__repr__", "", [](const LinkTreeJoint& self) {
    return "LinkTreeJoint('" + self.name + "', " + self.type + ", '" + self.parent_link + "' -> '" +
           self.child_link + "')";
  });
  auto tree = bind_class<LinkTree>(
      m, "LinkTree",
      "The links of a URDF and the joints between them, depth first from the root; str() draws the "
      "tree.",
      "LinkTree.from_urdf(path_or_xml)");
  def_static(tree, "from_urdf", "path_or_xml, link=None", fn<&tree_from_urdf>,
             R"(Reads the tree of a URDF.

Args:
    path_or_xml: a path, or the URDF itself: a str whose first character is '<', or bytes.
    link: a link of the tree that is meant, where the links hang in several.

Raises:
    UrdfError: the file or the XML is no good, or there are several trees.)");
  add_property(tree, "robot_name", &LinkTree::robot_name, "Name in the URDF.");
  add_property(tree, "links", &LinkTree::links, "Names of all links, the root first.");
  add_property(tree, "joints", &LinkTree::joints, "All joints.");
  add_property(tree, "tips", &tips_of,
               "The links without children, each with the number of joints that move it.");
  def(tree, "__str__", "", fn<&LinkTree::draw>);
  def(tree, "__repr__", "", fn<&tree_repr>);
  def_pickle(tree, fn<&tree_state>, "robot_name, root, joints, tips", fn<&tree_from_state>);
}

}  // namespace iksel::python
