// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "scene_types.hpp"

namespace iksel::python {

Place FromPython<Place>::convert(py::handle value, const char* name) {
  static const Task position = Task::position_only();
  return Place(check_pose(as_pose(value, name, &position), name));
}

namespace {

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

}  // namespace

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

}  // namespace iksel::python
