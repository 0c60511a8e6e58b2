// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "html.hpp"
#include "iksel/scene.hpp"
#include "joint_values.hpp"
#include "obstacle_fields.hpp"
#include "scene_arguments.hpp"

namespace iksel::python {

namespace {

void move_obstacle(Scene& self, const std::string& name, const Place& pose) {
  self.move(name, pose);
}

void remove_thing(Scene& self, const std::string& name) { self.remove(name); }

void attach(Scene& self, const std::string& name, const std::string& link, const ArrayLike& spheres,
            const std::optional<Names>& may_touch) {
  AttachedObject object;
  object.link = link;
  object.spheres = as_spheres(spheres, "spheres");
  if (may_touch) object.may_touch = as_names(*may_touch, "may_touch");
  self.attach(name, object);
}

void bind_changes(py::class_<Scene>& cls) {
  def(cls, "move", "name, pose", fn<&move_obstacle>,
      R"(Puts an obstacle elsewhere.

Args:
    name: of the obstacle.
    pose: T_base_obstacle [m], or a position (3,), unturned.

Raises:
    UnknownNameError: no obstacle has that name.
    InvalidArgumentError: a pose that is none.)");
  def(cls, "attach", "name, link, spheres, may_touch=None", fn<&attach>,
      R"(Has a link carry an object from now on.

Args:
    name: of the object, under which one that is there is replaced.
    link: that carries it.
    spheres: that cover it, (N, 4), rows of centre in the link's frame and radius [m].
    may_touch: links and other objects that it may touch; what does not move against it always may.

Raises:
    UnknownNameError: the URDF lacks the link, or nothing has a name of `may_touch`.
    InvalidArgumentError: a sphere that is no good, or a name that a link or an obstacle has.)");
  def(cls, "remove", "name", fn<&remove_thing>,
      R"(Removes an obstacle or an attached object.

Args:
    name: its name.

Raises:
    UnknownNameError: nothing has that name.)");
}

Scene make_scene(const Robot& robot, const RobotSpheres& spheres,
                 const std::optional<JointValues>& other_joints) {
  return Scene(robot, spheres, other_joints.value_or(JointValues()));
}

BoolOrArray is_free(const Scene& self, const ArrayLike& q) {
  return to_bool_or_array(
      map_joints<bool>(q, self.robot().dof(), "q", {},
                       [&](const JointVector& joints, bool* out) { *out = self.is_free(joints); }));
}

std::vector<Contact> contacts(const Scene& self, const ArrayLike& q) {
  return self.contacts(as_joints(q, self.robot().dof(), "q"));
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

py::dict scene_state(const Scene& self) {
  py::dict state;
  state["robot"] = self.robot();
  state["spheres"] = self.spheres();
  state["other_joints"] = self.other_joints();
  state["obstacles"] = self.obstacles();
  py::dict attached;
  for (const auto& [name, object] : self.attached()) {
    attached[name.c_str()] =
        py::make_tuple(object.link, sphere_rows(object.spheres), object.may_touch);
  }
  state["attached"] = attached;
  return state;
}

Scene scene_from_state(const Robot& robot, const RobotSpheres& spheres,
                       const JointValues& other_joints, const py::object& obstacles,
                       const py::object& attached) {
  Scene scene(robot, spheres, other_joints);
  const char* name_of_obstacles = "pickled Scene, obstacles";
  for (const auto& [name, obstacle] : copy_of_dict(obstacles, name_of_obstacles)) {
    if (!is_a<Obstacle>(obstacle)) throw_wrong_type(name_of_obstacles, "Obstacles", obstacle);
    scene.set(from_python<std::string>(name, name_of_obstacles), made<Obstacle>(obstacle));
  }
  const char* name_of_attached = "pickled Scene, attached";
  // What objects may touch may be an object that comes later.
  std::vector<std::pair<std::string, AttachedObject>> all;
  for (const auto& [name, parts] : copy_of_dict(attached, name_of_attached)) {
    if (!py::isinstance<py::tuple>(parts) || py::len(parts) != 3) {
      throw_wrong_type(name_of_attached, "tuples of 3", parts);
    }
    const auto three = py::reinterpret_borrow<py::tuple>(parts);
    AttachedObject object;
    object.link = from_python<std::string>(three[0], name_of_attached);
    object.spheres = as_spheres(three[1], name_of_attached);
    scene.attach(from_python<std::string>(name, name_of_attached), object);
    object.may_touch = as_names(three[2], name_of_attached);
    all.emplace_back(from_python<std::string>(name, name_of_attached), object);
  }
  for (const auto& [name, object] : all) scene.attach(name, object);
  return scene;
}

}  // namespace

void bind_scene(py::module_& m) {
  bind_robot_spheres(m);
  auto contact = bind_fields<Contact>(m, "Scene.contacts");
  def(contact, "__repr__", "", [](const Contact& self) {
    return "Contact('" + self.link + "', '" + self.other + "', depth=" + short_number(self.depth) +
           ")";
  });
  bind_obstacle(m);
  auto cls = bind_class<Scene>(
      m, "Scene",
      "A robot's body and what it may not touch: obstacles, objects that it carries, itself.\n\n"
      "A value: a copy does not see what is done to another, and a solve takes it as it is then. "
      "Links that no joint of the arm moves are not held against obstacles.");
  def_init(cls, "robot, spheres, other_joints=None", fn<&make_scene>,
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
  def(cls, "is_free", "q", fn<&is_free>,
      "Whether nothing touches at q [rad or m], (dof,); of (N, dof) values each, (N,).");
  def(cls, "contacts", "q", fn<&contacts>,
      "What touches at q, (dof,) [rad or m], the deepest first: of each link and each thing that "
      "it touches, where they overlap most.");
  def_copies(cls);
  def(cls, "__repr__", "", [](const Scene& self) {
    return "Scene(" + repr_text(py::cast(self.robot())) + ", " +
           std::to_string(self.obstacles().size()) + " obstacles, " +
           std::to_string(self.attached().size()) + " attached)";
  });
  def_pickle(cls, fn<&scene_state>, "robot, spheres, other_joints, obstacles, attached",
             fn<&scene_from_state>);
}

}  // namespace iksel::python
