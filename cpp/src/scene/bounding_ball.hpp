// SPDX-License-Identifier: BSD-3-Clause
// One ball around many.
#pragma once

#include <algorithm>
#include <vector>

#include "iksel/robot_spheres.hpp"

namespace iksel {

/// A ball around the spheres, of which there is one at least: close to the smallest (steps towards
/// the farthest, ever smaller: Badoiu and Clarkson, "Smaller core-sets for balls", 2003).
inline Sphere ball_around(const std::vector<Sphere>& spheres) {
  if (spheres.size() == 1) return spheres.front();
  const auto reach = [](const Eigen::Vector3d& from, const Sphere& to) {
    return (to.centre - from).norm() + to.radius;
  };
  Sphere ball{spheres.front().centre, 0};
  const auto farthest = [&] {
    return *std::max_element(spheres.begin(), spheres.end(), [&](const auto& a, const auto& b) {
      return reach(ball.centre, a) < reach(ball.centre, b);
    });
  };
  for (int i = 1; i <= 200; ++i) {
    const Sphere far = farthest();
    const Eigen::Vector3d way = far.centre - ball.centre;
    const double distance = way.norm();
    // Towards the point of that sphere that is farthest away.
    if (distance > 0) ball.centre += way * ((1 + far.radius / distance) / (i + 1));
  }
  // Rounding included.
  ball.radius = reach(ball.centre, farthest()) * (1 + 1e-12);
  return ball;
}

}  // namespace iksel
