// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "scene_types.hpp"

namespace iksel::python {

Place FromPython<Place>::convert(py::handle value, const char* name) {
  static const Task position = Task::position_only();
  return Place(check_pose(as_pose(value, name, &position), name));
}

namespace {

RobotSpheres make_spheres(
    const std::map<std::string, std::vector<Sphere>>& links,
    const std::optional<Iterable<std::pair<std::string, std::string>>>& pairs) {
  RobotSpheres spheres{links, {}};
  if (pairs) spheres.pairs = *pairs;
  spheres.validate();
  return spheres;
}

std::map<std::string, py::array_t<double>> links_of(const RobotSpheres& self) {
  std::map<std::string, py::array_t<double>> links;
  for (const auto& [name, spheres] : self.links) {
    links[name] = FromPython<std::vector<Sphere>>::show(spheres);
  }
  return links;
}

py::dict spheres_state(const RobotSpheres& self) {
  return py::dict("links"_a = links_of(self), "pairs"_a = self.pairs);
}

void bind_robot_spheres(py::module_& m) {
  auto cls = bind_class<RobotSpheres>(m, "RobotSpheres");
  def_init(cls, "links, pairs=None", fn<&make_spheres>,
           R"(Takes spheres as they are.

Args:
    links: for each link that has a body its spheres, (N, 4), rows of centre in the link's frame and
        radius [m].
    pairs: pairs of links that are looked at for collisions with each other; None: no pair.

Raises:
    InvalidArgumentError: a sphere that is not finite or whose radius is not above 0, a link
        without any, a pair of one link or of a link that is not in `links`.)");
  add_property(cls, "links", &links_of,
               "For each link its spheres, (N, 4), rows of centre in the link's frame and radius "
               "[m].");
  add_property(cls, "pairs", &RobotSpheres::pairs);
  def_repr(cls);
  def_pickle(cls, fn<&spheres_state>, "links, pairs", fn<&make_spheres>);
}

constexpr const char* kAddDoc = R"(

Args:
    name: its name, under which one that is there is replaced.
)";
constexpr const char* kPlaceDoc =
    R"(    pose: T_base_obstacle [m], as in Solver.solve; or a position (3,), unturned.
    margin: the arm keeps this far away [m].

Raises:
    InvalidArgumentError: a number or shape that is no good, or a name that a link or an attached
        object has.)";

std::string add_doc(const char* summary, const char* arguments) {
  return std::string(summary) + kAddDoc + arguments + kPlaceDoc;
}

template <class T>
using WithPlace = std::conditional_t<std::is_same_v<T, Pose>, Place, T>;

/// A method that adds what kMake gives.
template <auto kMake>
struct Add;
template <class... A, Obstacle (*kMake)(A...)>
struct Add<kMake> {
  void operator()(Scene& self, const std::string& name,
                  const WithPlace<Plain<A>>&... arguments) const {
    self.set(name, kMake(arguments...));
  }
};

void add_points(Scene& self, const std::string& name, const PointCloud& points, double radius,
                const std::optional<Place>& pose, double margin) {
  const Pose place = pose ? *pose : Pose::Identity();
  self.set(name, Obstacle::point_cloud(points, radius, place, margin));
}

/// The methods that add obstacles.
void bind_obstacles(py::class_<Scene>& cls) {
  def(cls, "add_sphere", "name, radius, pose, margin=0.0", Add<&Obstacle::sphere>(),
      add_doc("Adds a ball around the origin of its frame.", "    radius: above 0 [m].\n"));
  def(cls, "add_box", "name, size, pose, margin=0.0", Add<&Obstacle::box>(),
      add_doc("Adds a box centred at the origin of its frame.",
              "    size: edges along the axes of its frame, (3,) [m].\n"));
  def(cls, "add_capsule", "name, radius, length, pose, margin=0.0", Add<&Obstacle::capsule>(),
      add_doc("Adds all that is near a segment on the z axis of its frame, centred at the origin.",
              "    radius: how near, above 0 [m].\n    length: of the segment, 0 or more [m].\n"));
  def(cls, "add_cylinder", "name, radius, length, pose, margin=0.0", Add<&Obstacle::cylinder>(),
      add_doc("Adds a cylinder around the z axis of its frame, centred at the origin.",
              "    radius: above 0 [m].\n    length: above 0 [m].\n"));
  def(cls, "add_half_space", "name, pose, margin=0.0", Add<&Obstacle::half_space>(),
      add_doc("Adds all that is below the plane z = 0 of its frame.", ""));
  def(cls, "add_points", "name, points, radius, pose=None, margin=0.0", fn<&add_points>,
      add_doc("Adds a ball around each point of a cloud.",
              "    points: in the cloud's frame, (N, 3) [m].\n    radius: of the balls, 0 or more "
              "[m].\n"));
}

void move_obstacle(Scene& self, const std::string& name, const Place& pose) {
  self.move(name, pose);
}

void remove_thing(Scene& self, const std::string& name) { self.remove(name); }

void attach(Scene& self, const std::string& name, const std::string& link,
            const std::vector<Sphere>& spheres,
            const std::optional<Iterable<std::string>>& may_touch) {
  self.attach(name, {link, spheres, may_touch.value_or(Iterable<std::string>())});
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

/// A function of a scene: by the names of its attached objects what `get` gives of each.
template <class Get>
auto of_attached(const Get& get) {
  return [get](const Scene& self) {
    std::map<std::string, Plain<decltype(get(AttachedObject()))>> all;
    for (const auto& [name, object] : self.attached()) all[name] = get(object);
    return all;
  };
}

py::dict scene_state(const Scene& self) {
  py::dict attached;
  for (const auto& [name, object] : self.attached()) {
    attached[py::str(name)] = to_dict(&object, struct_type<AttachedObject>());
  }
  return py::dict("robot"_a = self.robot(), "spheres"_a = self.spheres(),
                  "other_joints"_a = self.other_joints(), "obstacles"_a = self.obstacles(),
                  "attached"_a = attached);
}

Scene scene_from_state(const Robot& robot, const RobotSpheres& spheres,
                       const JointValues& other_joints,
                       const std::map<std::string, Obstacle>& obstacles,
                       const std::map<std::string, AttachedObject>& attached) {
  Scene scene(robot, spheres, other_joints);
  for (const auto& [name, obstacle] : obstacles) scene.set(name, obstacle);
  // What objects may touch may be an object that comes later.
  for (const auto& [name, object] : attached) scene.attach(name, {object.link, object.spheres, {}});
  for (const auto& [name, object] : attached) scene.attach(name, object);
  return scene;
}

}  // namespace

void bind_scene(py::module_& m) {
  bind_robot_spheres(m);
  bind_fields<Contact>(m, "Scene.contacts");
  bind_fields<Obstacle>(m, "Scene.obstacles");
  auto cls = bind_class<Scene>(m, "Scene");
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
  add_properties(cls, "robot", &Scene::robot, "spheres", &Scene::spheres, "other_joints",
                 &Scene::other_joints, "obstacles", &Scene::obstacles);
  add_property(cls, "attached", of_attached(std::mem_fn(&AttachedObject::link)),
               "Names of the attached objects, and the links that carry them.");
  add_property(
      cls, "attached_spheres", of_attached([](const AttachedObject& each) {
        return FromPython<std::vector<Sphere>>::show(each.spheres);
      }),
      "Of each attached object its spheres, (N, 4), rows of centre in the link's frame and "
      "radius [m].");
  add_property(cls, "may_touch", of_attached(std::mem_fn(&AttachedObject::may_touch)),
               "Of each attached object the links and other objects that it may touch.");
  bind_obstacles(cls);
  bind_changes(cls);
  def(cls, "is_free", "q", fn<&is_free>,
      "Whether nothing touches at q [rad or m], (dof,); of (N, dof) values each, (N,).");
  def(cls, "contacts", "q", fn<&contacts>,
      "What touches at q, (dof,) [rad or m], the deepest first: of each link and each thing that "
      "it touches, where they overlap most.");
  def_copies(cls);
  def_repr(cls);
  def_pickle(cls, fn<&scene_state>, "robot, spheres, other_joints, obstacles, attached",
             fn<&scene_from_state>);
}

}  // namespace iksel::python
