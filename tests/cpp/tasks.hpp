// SPDX-License-Identifier: BSD-3-Clause
// A task of every kind, by name.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <iksel/iksel.hpp>
#include <vector>

namespace iksel_test {

struct NamedTask {
  const char* name;
  iksel::Task task;
};

inline std::vector<NamedTask> tasks() {
  iksel::Task
      one_sided;  // the hand may stop short of the target along the tool's z, and tilt a little
  one_sided.position_lower[2] = -0.02;
  one_sided.rotation_lower = {-0.1, -0.2, -0.05};
  one_sided.rotation_upper = {0.1, 0.2, 0.0};
  return {{"position only", iksel::Task::position_only()},
          {"free spin x", iksel::Task::free_spin(iksel::Axis::x)},
          {"free spin z", iksel::Task::free_spin()},
          {"upright", iksel::Task::upright()},
          {"planar", iksel::Task::planar()},
          {"box", iksel::Task::box({0.001, 0.002, 0.003}, {0.01, 0.02, 0.03})},
          {"cone", iksel::Task::box({0, 0, 0}, {0.3, 0.3, M_PI}, iksel::TaskFrame::tool)},
          {"slab", iksel::Task::box({0.5, 0.5, 0}, {0.2, 0.2, 1.0}, iksel::TaskFrame::base)},
          {"one-sided", one_sided}};
}

/// Angle between two directions [rad].
inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace iksel_test
