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

const std::shared_ptr<const PointGrid>& Scene::Data::grid_of(const Obstacle& cloud) {
  auto& grid = grids_[cloud.points];
  if (!grid) grid = std::make_shared<const PointGrid>(*cloud.points);
  return grid;
}

void Scene::Data::add(const Obstacle& obstacle) {
  const Pose pose(obstacle.pose);
  const Eigen::Matrix3d R = pose.linear();
  switch (obstacle.shape) {
    case Obstacle::Shape::sphere:
    case Obstacle::Shape::box:
    case Obstacle::Shape::capsule: {
      lanes::SceneBlock block{{}, {}, {}, obstacle.radius + obstacle.margin};
      copy_vector(pose.translation(), block.centre);
      for (int i = 0; i < 3; ++i) copy_vector(R.col(i), block.axis[i]);
      copy_vector(0.5 * obstacle.size, block.half);
      block.half[2] += 0.5 * obstacle.length;
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
    case Obstacle::Shape::points:
      clouds_.push_back(
          {grid_of(obstacle), StoredPose(pose.inverse()), obstacle.radius + obstacle.margin});
      break;
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
  for (const auto& [name, object] : attached) with_objects.attach(name, object);
  arm_ = std::move(with_objects);
}

lanes::SceneView Scene::Data::view() const {
  lanes::SceneView view{};
  arm_.show(view);
  view.blocks = static_cast<int>(blocks_.size());
  view.cylinders = static_cast<int>(cylinders_.size());
  view.planes = static_cast<int>(planes_.size());
  view.block = blocks_.data();
  view.cylinder = cylinders_.data();
  view.plane = planes_.data();
  return view;
}

void Scene::Data::find_clearance_pack(const double* q, int count, double* clearance) const {
  constexpr int kWidth = lanes::kWidth;
  const int dof = robot.dof();
  alignas(64) std::array<double, static_cast<std::size_t>(kMaxDof) * kWidth> packed;
  for (int lane = 0; lane < kWidth; ++lane) {
    // Lanes that nobody asks for do as the first does.
    const double* from = q + (lane < count ? lane : 0) * dof;
    for (int j = 0; j < dof; ++j) packed[static_cast<std::size_t>(j * kWidth + lane)] = from[j];
  }
  // Memory of its own for each thread, taken once.
  thread_local std::vector<double> centre;
  centre.resize(std::max(centre.size(), arm_.balls().size() * 3 * kWidth));
  alignas(64) std::array<double, kWidth> found;
  kernels_.find_clearance(view(), packed.data(), count, centre.data(), found.data());
  for (int lane = 0; lane < count; ++lane) {
    const double above = found[static_cast<std::size_t>(lane)];
    const bool touches_point =
        above > 0 && !clouds_.empty() && !is_free_of_points(centre.data(), lane);
    clearance[lane] = touches_point ? 0.0 : above;
  }
}

void Scene::Data::find_clearance(const double* q, std::size_t count, double* clearance) const {
  const auto dof = static_cast<std::size_t>(robot.dof());
  constexpr std::size_t kWidth = lanes::kWidth;
  for (std::size_t i = 0; i < count; i += kWidth) {
    const auto in_pack = static_cast<int>(std::min(kWidth, count - i));
    find_clearance_pack(q + i * dof, in_pack, clearance + i);
  }
}

void Scene::Data::find_free(const double* q, std::size_t count, bool* free) const {
  const auto dof = static_cast<std::size_t>(robot.dof());
  constexpr std::size_t kWidth = lanes::kWidth;
  std::array<double, kWidth> clearance{};
  for (std::size_t i = 0; i < count; i += kWidth) {
    const std::size_t in_pack = std::min(kWidth, count - i);
    find_clearance(q + i * dof, in_pack, clearance.data());
    for (std::size_t k = 0; k < in_pack; ++k) free[i + k] = clearance[k] > 0;
  }
}

bool Scene::Data::is_free_of_points(const double* centre, int lane) const {
  const auto at = [&](int ball) {
    const double* c = centre + 3 * ball * lanes::kWidth + lane;
    return Eigen::Vector3d(c[0], c[lanes::kWidth], c[2 * lanes::kWidth]);
  };
  for (const Cloud& cloud : clouds_) {
    const Pose T_cloud_base(cloud.T_cloud_base);
    const auto reach = [&](int ball) {
      return arm_.balls()[static_cast<std::size_t>(ball)].radius + cloud.radius;
    };
    for (const lanes::SceneLink& link : arm_.links()) {
      if (link.body == 0) continue;
      const int around = link.first - 1;
      if (!cloud.grid->may_touch(T_cloud_base * at(around), reach(around))) continue;
      for (int b = link.first; b < link.first + link.count; ++b) {
        if (cloud.grid->touches(T_cloud_base * at(b), reach(b))) return false;
      }
    }
  }
  return true;
}

}  // namespace iksel
