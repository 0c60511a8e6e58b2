// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "array_checks.hpp"
#include "iksel/pose.hpp"
#include "property.hpp"
#include "scene_arguments.hpp"

namespace iksel::python {
namespace {

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

py::object points_of(const Obstacle& self) {
  return self.points ? py::object(to_array(Matrix(*self.points))) : py::none();
}

}  // namespace

Pose as_place(const PoseLike& value) {
  static const Task position = Task::position_only();
  return check_pose(as_pose(value, "pose", &position), "pose");
}

void bind_obstacles(py::class_<Scene>& scene) {
  bind_rounded(scene);
  bind_flat(scene);
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

}  // namespace iksel::python
