// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene_data.hpp"

#include <algorithm>
#include <array>

#include "base/message_text.hpp"
#include "iksel/error.hpp"

namespace iksel {
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
      const bool is_box = obstacle.shape == Obstacle::Shape::box;
      const bool is_capsule = obstacle.shape == Obstacle::Shape::capsule;
      lanes::SceneBlock block{{}, {}, {}, obstacle.margin, 0};
      copy_vector(pose.translation(), block.centre);
      for (int i = 0; i < 3; ++i) copy_vector(R.col(i), block.axis[i]);
      if (is_box) copy_vector(0.5 * obstacle.size, block.half);
      if (is_capsule) block.half[2] = 0.5 * obstacle.length;
      if (!is_box) block.radius += obstacle.radius;
      // Rounding included.
      block.around =
          (Eigen::Map<const Eigen::Vector3d>(block.half).norm() + block.radius) * (1 + 1e-12);
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

}  // namespace iksel
