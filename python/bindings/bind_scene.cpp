// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "html.hpp"
#include "iksel/scene.hpp"
#include "joint_values.hpp"
#include "property.hpp"
#include "scene_arguments.hpp"

namespace iksel::python {

/// A truth value for one configuration, an array of them for many.
class FreeOrArray : public py::object {
  PYBIND11_OBJECT_DEFAULT(FreeOrArray, object, is_any_object)
};

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::FreeOrArray> {
  // Which of the two, the types of arrays do not tell.
  static constexpr auto name = const_name("bool | typing.Any");
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)

namespace iksel::python {

namespace {

void bind_contact(py::module_& m) {
  py::class_<Contact> cls(m, "Contact", "Two things that touch.");
  add_property(cls, "link", &Contact::link, "A link of the robot or an attached object.");
  add_property(cls, "other", &Contact::other,
               "What it touches: an obstacle, a link or an attached object.");
  add_property(cls, "is_obstacle", &Contact::is_obstacle, "Whether `other` is an obstacle.");
  add_property(cls, "depth", &Contact::depth,
               "How far they would have to part, margins included [m]; 0 or more.");
  cls.def("__repr__", [](const Contact& self) {
    return "Contact('" + self.link + "', '" + self.other + "', depth=" + short_number(self.depth) +
           ")";
  });
  cls.def(py::pickle(
      [](const Contact& self) -> py::object {
        return py::make_tuple(self.link, self.other, self.is_obstacle, self.depth);
      },
      [](const py::object& state) {
        PickleState in(state, "Contact", 4);
        Contact contact;
        contact.link = in.value<std::string>("link");
        contact.other = in.value<std::string>("other");
        contact.is_obstacle = in.value<bool>("is_obstacle");
        contact.depth = in.length("depth", /*may_be_nan=*/false);
        return contact;
      }));
}

void bind_changes(py::class_<Scene>& cls) {
  cls.def(
      "move",
      [](Scene& self, const Text& name, const PoseLike& pose) {
        self.move(from_python<std::string>(name, "name"), as_place(pose));
      },
      py::arg("name"), py::arg("pose"),
      R"(Puts an obstacle elsewhere.

Args:
    name: of the obstacle.
    pose: T_base_obstacle [m], or a position (3,), unturned.

Raises:
    UnknownNameError: no obstacle has that name.
    InvalidArgumentError: a pose that is none.)");
  cls.def(
      "attach",
      [](Scene& self, const Text& name, const Text& link, const ArrayLike& spheres,
         const std::optional<Names>& may_touch) {
        AttachedObject object;
        object.link = from_python<std::string>(link, "link");
        object.spheres = as_spheres(spheres, "spheres");
        if (may_touch) object.may_touch = as_names(*may_touch, "may_touch");
        self.attach(from_python<std::string>(name, "name"), object);
      },
      py::arg("name"), py::arg("link"), py::arg("spheres"), py::arg("may_touch") = py::none(),
      R"(Has a link carry an object from now on.

Args:
    name: of the object, under which one that is there is replaced.
    link: that carries it.
    spheres: that cover it, (N, 4), rows of centre in the link's frame and radius [m].
    may_touch: links and other objects that it may touch; what does not move against it always may.

Raises:
    UnknownNameError: the URDF lacks the link, or nothing has a name of `may_touch`.
    InvalidArgumentError: a sphere that is no good, or a name that a link or an obstacle has.)");
  cls.def(
      "remove",
      [](Scene& self, const Text& name) { self.remove(from_python<std::string>(name, "name")); },
      py::arg("name"),
      R"(Removes an obstacle or an attached object.

Args:
    name: its name.

Raises:
    UnknownNameError: nothing has that name.)");
}

FreeOrArray is_free(const Scene& self, const ArrayLike& q) {
  const auto free =
      map_joints<bool>(q, self.robot().dof(), "q", {},
                       [&](const JointVector& joints, bool* out) { *out = self.is_free(joints); });
  return FreeOrArray(free.ndim() == 0 ? py::object(py::bool_(*free.data())) : py::object(free));
}

std::map<std::string, std::string> carriers_of(const Scene& self) {
  std::map<std::string, std::string> links;
  for (const auto& [name, object] : self.attached()) links[name] = object.link;
  return links;
}

std::map<std::string, py::array_t<double>> spheres_of_attached(const Scene& self) {
  std::map<std::string, py::array_t<double>> spheres;
  for (const auto& [name, object] : self.attached()) spheres[name] = sphere_rows(object.spheres);
  return spheres;
}

std::map<std::string, std::vector<std::string>> touchable_by_attached(const Scene& self) {
  std::map<std::string, std::vector<std::string>> names;
  for (const auto& [name, object] : self.attached()) names[name] = object.may_touch;
  return names;
}

py::object scene_state(const Scene& self) {
  py::list obstacles;
  for (const auto& [name, o] : self.obstacles()) {
    obstacles.append(py::make_tuple(name, obstacle_state(o)));
  }
  py::list attached;
  for (const auto& [name, object] : self.attached()) {
    attached.append(
        py::make_tuple(name, object.link, sphere_rows(object.spheres), object.may_touch));
  }
  return py::make_tuple(self.robot(), self.spheres(), self.other_joints(), obstacles, attached);
}

Scene scene_from_state(const py::object& state) {
  PickleState in(state, "Scene", 5);
  const auto robot = in.value<Robot>("robot");
  const py::object spheres = in.object();
  if (!py::isinstance<RobotSpheres>(spheres)) {
    throw_wrong_type("pickled Scene, spheres", "RobotSpheres", spheres);
  }
  const auto others = as_joint_values(JointValues(in.object()), "pickled Scene, other_joints");
  Scene scene(robot, py::cast<RobotSpheres>(spheres), others);
  for (const py::handle item : in.list("obstacles")) {
    PickleState of(py::reinterpret_borrow<py::object>(item), "Scene, obstacle", 2);
    const auto name = of.value<std::string>("name");
    scene.set(name, obstacle_from_state(of.object()));
  }
  // What objects may touch may be an object that comes later.
  std::vector<std::pair<std::string, AttachedObject>> attached;
  for (const py::handle item : in.list("attached")) {
    PickleState of(py::reinterpret_borrow<py::object>(item), "Scene, attached object", 4);
    auto& [name, object] = attached.emplace_back();
    name = of.value<std::string>("name");
    object.link = of.value<std::string>("link");
    object.spheres = as_spheres(of.object(), "pickled Scene, spheres");
    object.may_touch = as_names(of.object(), "pickled Scene, may_touch");
    AttachedObject alone = object;
    alone.may_touch.clear();
    scene.attach(name, alone);
  }
  for (const auto& [name, object] : attached) scene.attach(name, object);
  return scene;
}

}  // namespace

void bind_scene(py::module_& m) {
  bind_robot_spheres(m);
  bind_contact(m);
  bind_obstacle(m);
  py::class_<Scene> cls(
      m, "Scene",
      "A robot's body and what it may not touch: obstacles, objects that it carries, itself.\n\n"
      "A value: a copy does not see what is done to another, and a solve takes it as it is then. "
      "Links that no joint of the arm moves are not held against obstacles.");
  cls.def(py::init([](const Loose<Robot>& robot, const RobotSpheres& spheres,
                      const std::optional<JointValues>& other_joints) {
            std::map<std::string, double> others;
            if (other_joints) others = as_joint_values(*other_joints, "other_joints");
            return Scene(from_python<Robot>(robot, "robot"), spheres, others);
          }),
          py::arg("robot"), py::arg("spheres"), py::arg("other_joints") = py::none(),
          R"(Begins with the robot alone.

Args:
    robot: whose joint values are asked about; solvers of the same chain take the scene, whatever
        their tool.
    spheres: its body, which iksel.spheres makes from a URDF or reads from a sphere file.
    other_joints: values of joints that are not the arm's [rad or m], by name, as in
        Robot.link_poses.

Raises:
    InvalidArgumentError: no spheres, or a base link that the arm's joints move.
    UnknownNameError: the URDF lacks a link of the spheres, or a joint.)");
  add_property(cls, "robot", &Scene::robot, "The robot.");
  add_property(cls, "spheres", &Scene::spheres, "Its body.");
  add_property(cls, "other_joints", &Scene::other_joints,
               "Values of joints that are not the arm's [rad or m], by name.");
  add_property(cls, "obstacles", &Scene::obstacles, "The obstacles by name.");
  add_property(cls, "attached", &carriers_of,
               "Names of the attached objects, and the links that carry them.");
  add_property(
      cls, "attached_spheres", &spheres_of_attached,
      "Of each attached object its spheres, (N, 4), rows of centre in the link's frame and "
      "radius [m].");
  add_property(cls, "may_touch", &touchable_by_attached,
               "Of each attached object the links and other objects that it may touch.");
  bind_obstacles(cls);
  bind_changes(cls);
  cls.def("is_free", &is_free, py::arg("q"),
          "Whether nothing touches at q [rad or m], (dof,); of (N, dof) values each, (N,).");
  cls.def(
      "contacts",
      [](const Scene& self, const ArrayLike& q) {
        return self.contacts(as_joints(q, self.robot().dof(), "q"));
      },
      py::arg("q"),
      "What touches at q, (dof,) [rad or m], the deepest first: of each link and each thing that "
      "it touches, where they overlap most.");
  cls.def("__copy__", [](const Scene& self) { return self; });
  cls.def(
      "__deepcopy__", [](const Scene& self, const py::dict&) { return self; }, py::arg("memo"));
  cls.def("__repr__", [](const Scene& self) {
    return "Scene(" + py::cast<std::string>(py::repr(py::cast(self.robot()))) + ", " +
           std::to_string(self.obstacles().size()) + " obstacles, " +
           std::to_string(self.attached().size()) + " attached)";
  });
  cls.def(py::pickle(&scene_state, &scene_from_state));
}

}  // namespace iksel::python
