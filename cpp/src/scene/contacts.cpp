// SPDX-License-Identifier: BSD-3-Clause
// What touches, and how deep: one configuration, in plain numbers.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.hpp"
#include "scene/scene_data.hpp"

namespace iksel {
namespace {

/// Distance from the surface of what has that distance along and across its sides, below 0 inside.
double distance_outside(const Eigen::Vector3d& beyond) {
  return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

/// Distance of a point from an obstacle without its margin, below 0 inside [m].
double signed_distance(const Obstacle& obstacle, const PointGrid* grid,
                       const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = Pose(obstacle.pose).inverse() * point;
  switch (obstacle.shape) {
    case Obstacle::Shape::sphere:
      return p.norm() - obstacle.radius;
    case Obstacle::Shape::box:
      return distance_outside(p.cwiseAbs() - 0.5 * obstacle.size);
    case Obstacle::Shape::capsule: {
      const double half = 0.5 * obstacle.length;
      const double along = std::min(std::max(p.z(), -half), half);
      return (p - along * Eigen::Vector3d::UnitZ()).norm() - obstacle.radius;
    }
    case Obstacle::Shape::cylinder: {
      const double across = p.head<2>().norm() - obstacle.radius;
      return distance_outside({across, std::abs(p.z()) - 0.5 * obstacle.length, -kInfinity});
    }
    case Obstacle::Shape::half_space:
      return p.z();
    case Obstacle::Shape::points:
      return grid->nearest(p) - obstacle.radius;
  }
  return kInfinity;
}

}  // namespace

void Scene::Data::add_contacts(std::size_t link, const std::vector<Sphere>& placed,
                               std::vector<Contact>& found) const {
  for (const auto& [name, obstacle] : obstacles) {
    const auto grid = grids_.find(obstacle.points);
    const PointGrid* points = grid == grids_.end() ? nullptr : grid->second.get();
    double depth = -kInfinity;
    for (const Sphere& sphere : placed) {
      const double distance = signed_distance(obstacle, points, sphere.centre);
      depth = std::max(depth, sphere.radius + obstacle.margin - distance);
    }
    if (depth >= 0) found.push_back({arm_.names()[link], name, true, depth});
  }
}

void Scene::Data::add_pair_contacts(const std::vector<std::vector<Sphere>>& placed,
                                    std::vector<Contact>& found) const {
  for (const lanes::ScenePair& pair : arm_.pairs()) {
    const auto a = static_cast<std::size_t>(pair.a);
    const auto b = static_cast<std::size_t>(pair.b);
    double depth = -kInfinity;
    for (const Sphere& one : placed[a]) {
      for (const Sphere& other : placed[b]) {
        const double distance = (one.centre - other.centre).norm();
        depth = std::max(depth, one.radius + other.radius - distance);
      }
    }
    if (depth >= 0) found.push_back({arm_.names()[a], arm_.names()[b], false, depth});
  }
}

std::vector<Contact> Scene::Data::contacts(const JointVector& q) const {
  const auto placed = arm_.spheres_at(robot.link_poses(q, other_joints));
  std::vector<Contact> found;
  for (std::size_t link = 0; link < placed.size(); ++link) {
    if (arm_.links()[link].body != 0) add_contacts(link, placed[link], found);
  }
  add_pair_contacts(placed, found);
  std::stable_sort(found.begin(), found.end(),
                   [](const Contact& a, const Contact& b) { return a.depth > b.depth; });
  return found;
}

}  // namespace iksel
