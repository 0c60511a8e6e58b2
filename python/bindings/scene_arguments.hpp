// SPDX-License-Identifier: BSD-3-Clause
// What scenes are made from, as Python gives it.
#pragma once

#include <string>
#include <vector>

#include "bindings.hpp"
#include "iksel/scene.hpp"
#include "pickle.hpp"
#include "pose_arguments.hpp"
#include "python_types.hpp"

namespace iksel::python {

class Names : public py::object {
  PYBIND11_OBJECT_DEFAULT(Names, object, is_any_object)
};

using Text = Loose<std::string>;
using Number = Loose<double>;

/// Spheres (N, 4): centre and radius.
std::vector<Sphere> as_spheres(py::handle value, const char* name);
py::array_t<double> sphere_rows(const std::vector<Sphere>& spheres);
/// Steps over what is no text.
py::iterator iterate(py::handle value, const char* name, const char* expected);
std::vector<std::string> as_names(py::handle value, const char* name);

/// A pose, or a position of what is not turned.
Pose as_place(const PoseLike& value);
py::object obstacle_state(const Obstacle& self);
Obstacle obstacle_from_state(const py::object& state);

// Parts of a module with scenes.

void bind_robot_spheres(py::module_& m);
void bind_obstacle(py::module_& m);
/// The methods that add obstacles.
void bind_obstacles(py::class_<Scene>& scene);

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::Names> {
  static constexpr auto name = const_name("collections.abc.Iterable[str]");
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)
