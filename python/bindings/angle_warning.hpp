// SPDX-License-Identifier: BSD-3-Clause
// The warning that joint values look like degrees, as iksel._base.angles gives it for other angles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "python_types.hpp"

namespace iksel::python {

/// Whether all angles are whole numbers, some over a turn of 2 pi.
inline bool look_like_degrees(const double* angles, std::ptrdiff_t count) {
  constexpr double kTurn = 6.283185307179586;
  const auto is_whole = [](double x) { return std::isfinite(x) && x == std::nearbyint(x); };
  const auto is_beyond = [](double x) { return std::abs(x) > kTurn; };
  return std::all_of(angles, angles + count, is_whole) &&
         std::any_of(angles, angles + count, is_beyond);
}

/// Whether the values of all joints that turn look so.
inline bool looks_like_degrees(const Robot& robot, const JointVector& q) {
  std::array<double, kMaxDof> angles;
  std::ptrdiff_t count = 0;
  for (int i = 0; i < robot.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (robot.joint_types()[k] != JointType::prismatic) {
      angles[static_cast<std::size_t>(count++)] = q[i];
    }
  }
  return look_like_degrees(angles.data(), count);
}

/// Warns that the angles of an argument look so.
inline void warn_of_degrees(const char* name) {
  const py::object category = py::module_::import("iksel_cpp").attr("AngleUnitWarning");
  const std::string text = std::string(name) +
                           ": these angles look like degrees, and are taken as radians "
                           "(numpy.radians converts)";
  if (PyErr_WarnEx(category.ptr(), text.c_str(), 1) != 0) throw py::error_already_set();
}

/// Warns if any of the configurations looks so.
inline void warn_of_degrees(const Robot& robot, const std::vector<JointVector>& all,
                            const char* name) {
  if (std::none_of(all.begin(), all.end(),
                   [&](const JointVector& q) { return looks_like_degrees(robot, q); })) {
    return;
  }
  warn_of_degrees(name);
}

}  // namespace iksel::python
