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

void Scene::Data::add_contacts(int link, const std::vector<Eigen::Vector3d>& centre,
                               std::vector<Contact>& found) const {
  const auto radius = [&](int b) { return arm_.balls()[static_cast<std::size_t>(b)].radius; };
  const auto at = [&](int b) { return centre[static_cast<std::size_t>(b)]; };
  const lanes::SceneLink& of = arm_.links()[static_cast<std::size_t>(link)];
  for (const auto& [name, obstacle] : obstacles) {
    const auto grid = grids_.find(obstacle.points);
    const PointGrid* points = grid == grids_.end() ? nullptr : grid->second.get();
    double depth = -kInfinity;
    for (int b = of.first; b < of.first + of.count; ++b) {
      const double distance = signed_distance(obstacle, points, at(b));
      depth = std::max(depth, radius(b) + obstacle.margin - distance);
    }
    if (depth >= 0) {
      found.push_back({arm_.names()[static_cast<std::size_t>(link)], name, true, depth});
    }
  }
}

void Scene::Data::add_pair_contacts(const std::vector<Eigen::Vector3d>& centre,
                                    std::vector<Contact>& found) const {
  const auto radius = [&](int b) { return arm_.balls()[static_cast<std::size_t>(b)].radius; };
  const auto at = [&](int b) { return centre[static_cast<std::size_t>(b)]; };
  for (const lanes::ScenePair& pair : arm_.pairs()) {
    const auto ia = static_cast<std::size_t>(pair.a);
    const auto ib = static_cast<std::size_t>(pair.b);
    const lanes::SceneLink& a = arm_.links()[ia];
    const lanes::SceneLink& b = arm_.links()[ib];
    double depth = -kInfinity;
    for (int i = a.first; i < a.first + a.count; ++i) {
      for (int j = b.first; j < b.first + b.count; ++j) {
        const double distance = (at(i) - at(j)).norm();
        depth = std::max(depth, radius(i) + radius(j) - distance);
      }
    }
    if (depth >= 0) found.push_back({arm_.names()[ia], arm_.names()[ib], false, depth});
  }
}

std::vector<Contact> Scene::Data::contacts(const double* q) const {
  const std::vector<Eigen::Vector3d> centre = arm_.centres(q);
  std::vector<Contact> found;
  for (int link = 0; link < static_cast<int>(arm_.links().size()); ++link) {
    if (arm_.links()[static_cast<std::size_t>(link)].body != 0) {
      add_contacts(link, centre, found);
    }
  }
  add_pair_contacts(centre, found);
  std::stable_sort(found.begin(), found.end(),
                   [](const Contact& a, const Contact& b) { return a.depth > b.depth; });
  return found;
}

}  // namespace iksel
