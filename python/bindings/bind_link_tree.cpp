// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "iksel/link_tree.hpp"
#include "iksel/urdf_text.hpp"
#include "pickle.hpp"
#include "urdf_source.hpp"

namespace iksel::python {

namespace {

LinkTree tree_from_urdf(const UrdfSource& path_or_xml,
                        const std::optional<Loose<std::string>>& link) {
  const std::string name = link ? from_python<std::string>(*link, "link") : "";
  return read_urdf(
      path_or_xml, [&](const std::string& xml) { return LinkTree::from_urdf_string(xml, name); },
      [&](const std::filesystem::path& path) { return LinkTree::from_urdf_file(path, name); });
}

std::string tree_repr(const LinkTree& self) {
  return "LinkTree(" + py::cast<std::string>(py::repr(py::str(self.robot_name))) + ", " +
         std::to_string(self.links.size()) + " links, " + std::to_string(self.tips.size()) +
         " tips)";
}

py::object joint_state(const LinkTreeJoint& self) {
  return py::make_tuple(self.name, self.type, self.parent_link, self.child_link);
}

LinkTreeJoint joint_from_state(const py::object& state) {
  PickleState in(state, "LinkTreeJoint", 4);
  LinkTreeJoint joint;
  joint.name = in.value<std::string>("name");
  joint.type = in.value<std::string>("type");
  joint.parent_link = in.value<std::string>("parent_link");
  joint.child_link = in.value<std::string>("child_link");
  return joint;
}

/// Joint after joint, each leading to the next link.
py::object tree_state(const LinkTree& self) {
  py::list joints;
  for (const LinkTreeJoint& joint : self.joints) joints.append(joint_state(joint));
  py::list tips;
  for (const auto& [link, moving] : self.tips) tips.append(py::make_tuple(link, moving));
  return py::make_tuple(self.robot_name, self.links.front(), joints, tips);
}

LinkTree tree_from_state(const py::object& state) {
  PickleState in(state, "LinkTree", 4);
  LinkTree tree;
  tree.robot_name = in.value<std::string>("robot_name");
  tree.links = {in.value<std::string>("root")};
  for (const py::handle joint : in.list("joints")) {
    tree.joints.push_back(joint_from_state(py::reinterpret_borrow<py::object>(joint)));
    tree.links.push_back(tree.joints.back().child_link);
  }
  for (const py::handle tip : in.list("tips")) {
    PickleState of_tip(py::reinterpret_borrow<py::object>(tip), "LinkTree, tip", 2);
    const auto link = of_tip.value<std::string>("link");
    tree.tips.push_back({link, of_tip.count("moving joints")});
  }
  return tree;
}

}  // namespace

void bind_link_tree(py::module_& m) {
  m.def(
      "mend_xml",
      [](const py::bytes& data, const std::string& link) { return mend_xml(data, link); },
      py::arg("data"), py::arg("link") = "",
      R"(The text of an XML file (URDF, SRDF, MJCF) as every XML reader takes it.

It is UTF-8, with what people and exporters get wrong mended where it is clear what is meant; a DOCTYPE,
comments and a default namespace are left out, and quat_xyzw of URDF 1.1 becomes rpy.

Args:
    data: the bytes of the file.
    link: of a URDF whose links hang in several trees, the one of this link is left.

Raises:
    UrdfError: it is not clear what is meant; the message says the line.)");
  py::class_<LinkTreeJoint>(m, "LinkTreeJoint", "One joint of a URDF.")
      .def_readonly("name", &LinkTreeJoint::name, "Its name.")
      .def_readonly("type", &LinkTreeJoint::type, "'revolute', 'fixed', ...")
      .def_readonly("parent_link", &LinkTreeJoint::parent_link, "The link that it is on.")
      .def_readonly("child_link", &LinkTreeJoint::child_link, "The link that it carries.")
      .def(py::pickle(&joint_state, &joint_from_state))
      .def("__repr__", [](const LinkTreeJoint& self) {
        return "LinkTreeJoint('" + self.name + "', " + self.type + ", '" + self.parent_link +
               "' -> '" + self.child_link + "')";
      });
  py::class_<LinkTree>(m, "LinkTree",
                       "The links of a URDF and the joints between them, depth first from the "
                       "root; str() draws the tree.")
      .def_static("from_urdf", &tree_from_urdf, py::arg("path_or_xml"),
                  py::arg("link") = py::none(),
                  R"(Reads the tree of a URDF.

Args:
    path_or_xml: a path, or the URDF itself: a str whose first character is '<', or bytes.
    link: a link of the tree that is meant, where the links hang in several.

Raises:
    UrdfError: the file or the XML is no good, or there are several trees.)")
      .def_readonly("robot_name", &LinkTree::robot_name, "Name in the URDF.")
      .def_readonly("links", &LinkTree::links, "Names of all links, the root first.")
      .def_readonly("joints", &LinkTree::joints, "All joints.")
      .def_property_readonly(
          "tips",
          [](const LinkTree& self) {
            std::vector<std::pair<std::string, int>> tips;
            for (const auto& [link, moving] : self.tips) tips.emplace_back(link, moving);
            return tips;
          },
          "The links without children, each with the number of joints that move it.")
      .def("__str__", &LinkTree::draw)
      .def("__repr__", &tree_repr)
      .def(py::pickle(&tree_state, &tree_from_state));
}

}  // namespace iksel::python
