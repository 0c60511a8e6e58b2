// SPDX-License-Identifier: BSD-3-Clause
// The warning that joint values look like degrees, as iksel._angles gives it for other angles.
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "iksel/robot.hpp"
#include "python_types.hpp"

namespace iksel::python {

/// Whether the values of all joints that turn are whole numbers, some over a turn of 2 pi.
inline bool looks_like_degrees(const Robot& robot, const JointVector& q) {
  constexpr double kTurn = 6.283185307179586;
  bool beyond = false;
  for (int i = 0; i < robot.dof(); ++i) {
    if (robot.joint_types()[static_cast<std::size_t>(i)] == JointType::prismatic) continue;
    if (q[i] != std::nearbyint(q[i])) return false;
    beyond = beyond || std::abs(q[i]) > kTurn;
  }
  return beyond;
}

/// Warns if any of the configurations looks so.
inline void warn_of_degrees(const Robot& robot, const std::vector<JointVector>& all,
                            const char* name) {
  if (std::none_of(all.begin(), all.end(),
                   [&](const JointVector& q) { return looks_like_degrees(robot, q); })) {
    return;
  }
  const py::object category = py::module_::import("iksel_cpp").attr("AngleUnitWarning");
  const std::string text = std::string(name) +
                           ": these angles look like degrees, and are taken as radians "
                           "(numpy.radians converts)";
  if (PyErr_WarnEx(category.ptr(), text.c_str(), 1) != 0) throw py::error_already_set();
}

}  // namespace iksel::python
