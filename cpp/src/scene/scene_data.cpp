// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene_data.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "iksel/error.hpp"

namespace iksel {
namespace {

/// A box of which each point is the centre of a ball.
struct RoundBox {
  Eigen::Vector3d half;  ///< of its edges [m]
  double radius = 0;     ///< [m]

  /// A box, a sphere or a capsule.
  explicit RoundBox(const Obstacle& obstacle) : half(0.5 * obstacle.size) {
    if (obstacle.shape == Obstacle::Shape::box) return;
    const bool is_capsule = obstacle.shape == Obstacle::Shape::capsule;
    half = {0, 0, is_capsule ? 0.5 * obstacle.length : 0.0};
    radius = obstacle.radius;
  }
};

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
    case Obstacle::Shape::box:
    case Obstacle::Shape::capsule: {
      const RoundBox box(obstacle);
      return distance_outside(p.cwiseAbs() - box.half) - box.radius;
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

void Scene::Data::check_name(const std::string& name, bool is_obstacle) const {
  const auto& links = robot.link_names();
  const bool is_link = std::find(links.begin(), links.end(), name) != links.end();
  const bool is_other = is_obstacle ? attached.count(name) > 0 : obstacles.count(name) > 0;
  if (!is_link && !is_other) return;
  const std::string what = is_link       ? "a link of the robot"
                           : is_obstacle ? "an attached object"
                                         : "an obstacle";
  throw InvalidArgumentError("name: '" + name + "' is " + what + " already");
}

void Scene::Data::add(const Obstacle& obstacle) {
  const Pose pose(obstacle.pose);
  const Eigen::Matrix3d R = pose.linear();
  switch (obstacle.shape) {
    case Obstacle::Shape::sphere:
    case Obstacle::Shape::box:
    case Obstacle::Shape::capsule: {
      const RoundBox box(obstacle);
      lanes::SceneBlock block{{}, {}, {}, obstacle.margin + box.radius, 0};
      copy_vector(pose.translation(), block.centre);
      for (int i = 0; i < 3; ++i) copy_vector(R.col(i), block.axis[i]);
      copy_vector(box.half, block.half);
      // Rounding included.
      block.around = (box.half.norm() + block.radius) * (1 + 1e-12);
      blocks_.push_back(block);
      break;
    }
    case Obstacle::Shape::cylinder: {
      lanes::SceneCylinder cylinder{
          {}, {}, obstacle.radius, 0.5 * obstacle.length, obstacle.margin};
      copy_vector(pose.translation(), cylinder.centre);
      copy_vector(R.col(2), cylinder.axis);
      cylinders_.push_back(cylinder);
      break;
    }
    case Obstacle::Shape::half_space: {
      lanes::ScenePlane plane{{}, R.col(2).dot(pose.translation()) + obstacle.margin};
      copy_vector(R.col(2), plane.normal);
      planes_.push_back(plane);
      break;
    }
    case Obstacle::Shape::points: {
      auto& grid = grids_[obstacle.points];
      if (!grid) grid = std::make_shared<const PointGrid>(*obstacle.points);
      clouds_.push_back({grid, StoredPose(pose.inverse()), obstacle.radius + obstacle.margin});
      break;
    }
  }
}

void Scene::Data::lay_out() {
  blocks_.clear();
  cylinders_.clear();
  planes_.clear();
  clouds_.clear();
  for (const auto& [name, obstacle] : obstacles) add(obstacle);
  for (auto it = grids_.begin(); it != grids_.end();) {
    const bool is_used = std::any_of(obstacles.begin(), obstacles.end(), [&](const auto& named) {
      return named.second.points == it->first;
    });
    it = is_used ? std::next(it) : grids_.erase(it);
  }
}

void Scene::Data::attach_all() {
  ArmShape with_objects = bare_;
  for (const auto& [name, object] : attached) {
    // What may touch the one may be touched by the other.
    AttachedObject both_ways = object;
    for (const auto& [other, of_other] : attached) {
      const auto& may = of_other.may_touch;
      if (std::find(may.begin(), may.end(), name) != may.end())
        both_ways.may_touch.push_back(other);
    }
    with_objects.attach(name, both_ways);
  }
  arm_ = std::move(with_objects);
  target_shape_ = TargetShape(arm_);
}

void Scene::Data::show_obstacles(lanes::SceneView& view) const {
  view.blocks = static_cast<int>(blocks_.size());
  view.cylinders = static_cast<int>(cylinders_.size());
  view.planes = static_cast<int>(planes_.size());
  view.block = blocks_.data();
  view.cylinder = cylinders_.data();
  view.plane = planes_.data();
}

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
