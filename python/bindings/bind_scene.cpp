// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "html.hpp"
#include "iksel/pose.hpp"
#include "iksel/scene.hpp"
#include "joint_values.hpp"
#include "pickle.hpp"
#include "pose_arguments.hpp"
#include "property.hpp"
#include "python_types.hpp"

namespace iksel::python {

/// Names of links, and spheres (N, 4).
class SphereTable : public py::object {
  PYBIND11_OBJECT_DEFAULT(SphereTable, object, is_any_object)
};
/// Pairs of names.
class NamePairs : public py::object {
  PYBIND11_OBJECT_DEFAULT(NamePairs, object, is_any_object)
};
class Names : public py::object {
  PYBIND11_OBJECT_DEFAULT(Names, object, is_any_object)
};
/// A truth value for one configuration, an array of them for many.
class FreeOrArray : public py::object {
  PYBIND11_OBJECT_DEFAULT(FreeOrArray, object, is_any_object)
};

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::SphereTable> {
  static constexpr auto name = const_name("collections.abc.Mapping[str, numpy.typing.ArrayLike]");
};
template <>
struct handle_type_name<iksel::python::NamePairs> {
  static constexpr auto name = const_name("collections.abc.Iterable[tuple[str, str]]");
};
template <>
struct handle_type_name<iksel::python::Names> {
  static constexpr auto name = const_name("collections.abc.Iterable[str]");
};
template <>
struct handle_type_name<iksel::python::FreeOrArray> {
  // Which of the two, the types of arrays do not tell.
  static constexpr auto name = const_name("bool | typing.Any");
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)

namespace iksel::python {

namespace {

/// Spheres (N, 4): centre and radius.
std::vector<Sphere> as_spheres(py::handle value, const char* name) {
  const DoubleArray array = as_doubles(value, name);
  if (array.ndim() != 2 || array.shape(1) != 4) {
    throw_wrong_shape(name, "an (N, 4) array, rows of centre and radius", array);
  }
  std::vector<Sphere> spheres;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const double* row = array.data(i);
    spheres.push_back({{row[0], row[1], row[2]}, row[3]});
  }
  return spheres;
}

py::array_t<double> sphere_rows(const std::vector<Sphere>& spheres) {
  py::array_t<double> array({static_cast<py::ssize_t>(spheres.size()), py::ssize_t{4}});
  double* out = array.mutable_data();
  for (const Sphere& sphere : spheres) {
    out = std::copy_n(sphere.centre.data(), 3, out);
    *out++ = sphere.radius;
  }
  return array;
}

py::iterator iterate(py::handle value, const char* name, const char* expected) {
  if (py::isinstance<py::str>(value) || !py::isinstance<py::iterable>(value)) {
    throw_wrong_type(name, expected, value);
  }
  return py::iter(value);
}

std::vector<std::string> as_names(py::handle value, const char* name) {
  std::vector<std::string> names;
  for (py::iterator it = iterate(value, name, "names"); it != py::iterator::sentinel(); ++it) {
    names.push_back(from_python<std::string>(*it, name));
  }
  return names;
}

RobotSpheres make_spheres(const SphereTable& links, const std::optional<NamePairs>& pairs) {
  RobotSpheres spheres;
  if (!py::hasattr(links, "keys")) {
    throw_wrong_type("links", "a mapping of names to (N, 4) arrays", links);
  }
  for (const auto& [key, rows] : py::dict(py::object(links))) {
    const auto link = from_python<std::string>(key, "links");
    spheres.links[link] = as_spheres(rows, ("links['" + link + "']").c_str());
  }
  if (pairs) {
    for (py::iterator it = iterate(*pairs, "pairs", "pairs of names");
         it != py::iterator::sentinel(); ++it) {
      std::vector<std::string> pair = as_names(*it, "pairs");
      if (pair.size() != 2) throw_wrong_type("pairs", "two names", *it);
      spheres.pairs.emplace_back(std::move(pair[0]), std::move(pair[1]));
    }
  }
  spheres.validate();
  return spheres;
}

std::map<std::string, py::array_t<double>> links_of(const RobotSpheres& self) {
  std::map<std::string, py::array_t<double>> links;
  for (const auto& [name, spheres] : self.links) links[name] = sphere_rows(spheres);
  return links;
}

std::size_t count_spheres(const RobotSpheres& self) {
  std::size_t count = 0;
  for (const auto& [name, spheres] : self.links) count += spheres.size();
  return count;
}

void bind_robot_spheres(py::module_& m) {
  py::class_<RobotSpheres> cls(
      m, "RobotSpheres",
      "Spheres that cover the links of a robot, and which links may not touch each other; made by "
      "iksel.spheres.");
  cls.def(py::init(&make_spheres), py::arg("links"), py::arg("pairs") = py::none(),
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
  add_property(cls, "pairs", &RobotSpheres::pairs,
               "Pairs of links that are looked at for collisions with each other.");
  cls.def("__repr__", [](const RobotSpheres& self) {
    return "RobotSpheres(" + std::to_string(count_spheres(self)) + " on " +
           std::to_string(self.links.size()) + " links, " + std::to_string(self.pairs.size()) +
           " pairs)";
  });
  cls.def(py::pickle([](const RobotSpheres& self)
                         -> py::object { return py::make_tuple(links_of(self), self.pairs); },
                     [](const py::object& state) {
                       PickleState in(state, "RobotSpheres", 2);
                       const auto links = py::reinterpret_borrow<SphereTable>(in.object());
                       return make_spheres(links, py::reinterpret_borrow<NamePairs>(in.object()));
                     }));
}

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

/// A pose, or a position of what is not turned.
Pose as_place(const PoseLike& value) {
  static const Task position = Task::position_only();
  return check_pose(as_pose(value, "pose", &position), "pose");
}

PointCloud as_points(const ArrayLike& value) {
  const DoubleArray array = as_doubles(value, "points");
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw_wrong_shape("points", "an (N, 3) array", array);
  }
  return Eigen::Map<const PointCloud>(array.data(), array.shape(0), 3);
}

Eigen::Vector3d as_size(const ArrayLike& value) {
  const DoubleArray array = as_doubles(value, "size");
  if (array.ndim() != 1 || array.shape(0) != 3) throw_wrong_shape("size", "a (3,) array", array);
  return {array.at(0), array.at(1), array.at(2)};
}

using Text = Loose<std::string>;
using Number = Loose<double>;

void set(Scene& scene, const Text& name, const Obstacle& obstacle) {
  scene.set(from_python<std::string>(name, "name"), obstacle);
}

double number(const Number& value, const char* name) { return from_python<double>(value, name); }

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

void bind_rounded(py::class_<Scene>& cls) {
  const Number none = py::float_(0.0);
  cls.def(
      "add_sphere",
      [](Scene& self, const Text& name, const Number& radius, const PoseLike& pose,
         const Number& margin) {
        set(self, name,
            Obstacle::sphere(number(radius, "radius"), as_place(pose), number(margin, "margin")));
      },
      py::arg("name"), py::arg("radius"), py::arg("pose"), py::arg("margin") = none,
      add_doc("Adds a ball around the origin of its frame.", "    radius: above 0 [m].\n").c_str());
  cls.def(
      "add_box",
      [](Scene& self, const Text& name, const ArrayLike& size, const PoseLike& pose,
         const Number& margin) {
        set(self, name, Obstacle::box(as_size(size), as_place(pose), number(margin, "margin")));
      },
      py::arg("name"), py::arg("size"), py::arg("pose"), py::arg("margin") = none,
      add_doc("Adds a box centred at the origin of its frame.",
              "    size: edges along the axes of its frame, (3,) [m].\n")
          .c_str());
  cls.def(
      "add_capsule",
      [](Scene& self, const Text& name, const Number& radius, const Number& length,
         const PoseLike& pose, const Number& margin) {
        set(self, name,
            Obstacle::capsule(number(radius, "radius"), number(length, "length"), as_place(pose),
                              number(margin, "margin")));
      },
      py::arg("name"), py::arg("radius"), py::arg("length"), py::arg("pose"),
      py::arg("margin") = none,
      add_doc("Adds all that is near a segment on the z axis of its frame, centred at the origin.",
              "    radius: how near, above 0 [m].\n    length: of the segment, 0 or more [m].\n")
          .c_str());
}

void bind_flat(py::class_<Scene>& cls) {
  const Number none = py::float_(0.0);
  cls.def(
      "add_cylinder",
      [](Scene& self, const Text& name, const Number& radius, const Number& length,
         const PoseLike& pose, const Number& margin) {
        set(self, name,
            Obstacle::cylinder(number(radius, "radius"), number(length, "length"), as_place(pose),
                               number(margin, "margin")));
      },
      py::arg("name"), py::arg("radius"), py::arg("length"), py::arg("pose"),
      py::arg("margin") = none,
      add_doc("Adds a cylinder around the z axis of its frame, centred at the origin.",
              "    radius: above 0 [m].\n    length: above 0 [m].\n")
          .c_str());
  cls.def(
      "add_half_space",
      [](Scene& self, const Text& name, const PoseLike& pose, const Number& margin) {
        set(self, name, Obstacle::half_space(as_place(pose), number(margin, "margin")));
      },
      py::arg("name"), py::arg("pose"), py::arg("margin") = none,
      add_doc("Adds all that is below the plane z = 0 of its frame.", "").c_str());
  cls.def(
      "add_points",
      [](Scene& self, const Text& name, const ArrayLike& points, const Number& radius,
         const std::optional<PoseLike>& pose, const Number& margin) {
        const Pose place = pose ? as_place(*pose) : Pose::Identity();
        set(self, name,
            Obstacle::point_cloud(as_points(points), number(radius, "radius"), place,
                                  number(margin, "margin")));
      },
      py::arg("name"), py::arg("points"), py::arg("radius"), py::arg("pose") = py::none(),
      py::arg("margin") = none,
      add_doc("Adds a ball around each point of a cloud.",
              "    points: in the cloud's frame, (N, 3) [m].\n    radius: of the balls, 0 or more "
              "[m].\n")
          .c_str());
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

py::object points_of(const Obstacle& self) {
  return self.points ? py::object(to_array(Matrix(*self.points))) : py::none();
}

py::object obstacle_state(const Obstacle& self) {
  return py::make_tuple(to_string(self.shape), self.radius, self.length,
                        to_array(JointVector(self.size)), points_of(self),
                        to_array(Pose(self.pose)), self.margin);
}

Obstacle obstacle_from_state(const py::object& state) {
  PickleState in(state, "Obstacle", 7);
  Obstacle out;
  const auto shape = in.value<std::string>("shape");
  using Shape = Obstacle::Shape;
  const auto shapes = {Shape::sphere,   Shape::box,        Shape::capsule,
                       Shape::cylinder, Shape::half_space, Shape::points};
  const auto* const at =
      std::find_if(shapes.begin(), shapes.end(), [&](Shape s) { return shape == to_string(s); });
  if (at == shapes.end()) in.refuse("shape", "a shape", shape);
  out.shape = *at;
  out.radius = in.value<double>("radius");
  out.length = in.value<double>("length");
  out.size = as_size(ArrayLike(in.object()));
  const py::object points = in.object();
  if (!points.is_none())
    out.points = std::make_shared<const PointCloud>(as_points(ArrayLike(points)));
  out.pose = StoredPose(as_pose(in.object(), "pickled Obstacle, pose"));
  out.margin = in.value<double>("margin");
  return out;
}

void bind_obstacle(py::module_& m) {
  py::class_<Obstacle> cls(m, "Obstacle", "A shape at a pose, as a Scene holds it.");
  add_property(
      cls, "shape", [](const Obstacle& self) { return std::string(to_string(self.shape)); },
      "'sphere', 'box', 'capsule', 'cylinder', 'half_space' or 'points'.");
  add_property(cls, "radius", &Obstacle::radius, "sphere, capsule, cylinder, points [m].");
  add_property(cls, "length", &Obstacle::length, "capsule: of its segment; cylinder [m].");
  add_property(
      cls, "size", [](const Obstacle& self) { return to_array(JointVector(self.size)); },
      "box: edges, (3,) [m].");
  add_property(cls, "points", &points_of, "In the obstacle's frame, (N, 3) [m]; None of others.");
  add_property(
      cls, "pose", [](const Obstacle& self) { return to_array(Pose(self.pose)); },
      "T_base_obstacle, (4, 4).");
  add_property(cls, "margin", &Obstacle::margin, "The arm keeps this far away [m].");
  cls.def("__repr__", [](const Obstacle& self) {
    return "Obstacle(" + std::string(to_string(self.shape)) + ")";
  });
  cls.def(py::pickle(&obstacle_state, &obstacle_from_state));
}

std::map<std::string, std::string> carriers_of(const Scene& self) {
  std::map<std::string, std::string> links;
  for (const auto& [name, object] : self.attached()) links[name] = object.link;
  return links;
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
  add_property(cls, "obstacles", &Scene::obstacles, "The obstacles by name.");
  add_property(cls, "attached", &carriers_of,
               "Names of the attached objects, and the links that carry them.");
  bind_rounded(cls);
  bind_flat(cls);
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
