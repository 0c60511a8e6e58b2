// SPDX-License-Identifier: BSD-3-Clause
// What scenes are made from, as Python gives it.
#pragma once

#include <string>
#include <vector>

#include "bindings.hpp"
#include "iksel/scene.hpp"
#include "pose_arguments.hpp"
#include "python_types.hpp"

namespace iksel::python {

struct Names : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "collections.abc.Iterable[str]";
};

/// Spheres (N, 4): centre and radius.
std::vector<Sphere> as_spheres(py::handle value, const char* name);
py::array_t<double> sphere_rows(const std::vector<Sphere>& spheres);
/// Steps over what is no text.
py::iterator iterate(py::handle value, const char* name, const char* expected);
std::vector<std::string> as_names(py::handle value, const char* name);

/// A pose, or a position of what is not turned.
struct Place : Pose {
  explicit Place(const Pose& pose) : Pose(pose) {}
};
template <>
struct FromPython<Place> {
  static std::string text() { return PoseLike::kText; }
  static Place convert(py::handle value, const char* name);
};

// Parts of a module with scenes.

void bind_robot_spheres(py::module_& m);
void bind_obstacle(py::module_& m);
/// The methods that add obstacles.
void bind_obstacles(py::class_<Scene>& scene);

}  // namespace iksel::python
