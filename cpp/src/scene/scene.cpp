// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/pose.hpp"
#include "scene/scene_data.hpp"

namespace iksel {
namespace {

double largest_of(const Eigen::Vector3d& v) { return v.cwiseAbs().maxCoeff(); }

/// Throws if a number of 0 or more is too large to compute with.
void check_size(const std::string& name, double number) {
  if (number <= kMaxCoordinate) return;
  throw InvalidArgumentError(name + ": " + too_large_text(number, "m"));
}

void check_spheres(const std::string& name, const std::vector<Sphere>& spheres) {
  if (spheres.empty()) throw InvalidArgumentError("spheres: '" + name + "' has none");
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Sphere& sphere = spheres[i];
    const bool is_good =
        sphere.centre.allFinite() && sphere.radius > 0 && std::isfinite(sphere.radius);
    const double largest = std::max(largest_of(sphere.centre), sphere.radius);
    if (is_good && largest <= kMaxCoordinate) continue;
    const std::string which = "spheres: number " + std::to_string(i) + " of '" + name + "'";
    if (is_good) check_size(which, largest);
    throw InvalidArgumentError(which + " is not finite, or its radius is not above 0 (" +
                               number_text(sphere.radius) + " m)");
  }
}

/// Throws unless the number is finite and 0 or more, or above 0.
void check_length(const char* name, double length, bool may_be_zero) {
  if (!std::isfinite(length) || !(may_be_zero ? length >= 0 : length > 0)) {
    throw InvalidArgumentError(std::string(name) + ": " + number_text(length) + " m is not " +
                               (may_be_zero ? "0 or more" : "above 0"));
  }
  check_size(name, length);
}

/// As check_pose, and throws where the place is too far away.
Pose check_place(const Pose& T_base_obstacle) {
  Pose pose = check_pose(T_base_obstacle);
  check_size("pose", largest_of(pose.translation()));
  return pose;
}

Obstacle make_obstacle(Obstacle::Shape shape, double radius, double length, const Pose& pose,
                       double margin) {
  return {shape, radius, length, Eigen::Vector3d::Zero(), nullptr, StoredPose(pose), margin};
}

std::vector<std::string> scene_names(const Scene::Data& data) {
  std::vector<std::string> names;
  for (const auto& [name, obstacle] : data.obstacles) names.push_back(name);
  for (const auto& [name, object] : data.attached) names.push_back(name);
  return names;
}

}  // namespace

void RobotSpheres::validate() const {
  for (const auto& [name, spheres] : links) check_spheres(name, spheres);
  for (const auto& [a, b] : pairs) {
    if (a == b) throw InvalidArgumentError("pairs: '" + a + "' with itself");
    for (const std::string& link : {a, b}) {
      if (links.count(link) == 0) {
        throw InvalidArgumentError("pairs: '" + link + "' has no spheres");
      }
    }
  }
}

Obstacle Obstacle::sphere(double radius, const Pose& T_base_obstacle, double margin) {
  return make_obstacle(Shape::sphere, radius, 0, T_base_obstacle, margin);
}

Obstacle Obstacle::box(const Eigen::Vector3d& size, const Pose& T_base_obstacle, double margin) {
  Obstacle obstacle = make_obstacle(Shape::box, 0, 0, T_base_obstacle, margin);
  obstacle.size = size;
  return obstacle;
}

Obstacle Obstacle::capsule(double radius, double length, const Pose& T_base_obstacle,
                           double margin) {
  return make_obstacle(Shape::capsule, radius, length, T_base_obstacle, margin);
}

Obstacle Obstacle::cylinder(double radius, double length, const Pose& T_base_obstacle,
                            double margin) {
  return make_obstacle(Shape::cylinder, radius, length, T_base_obstacle, margin);
}

Obstacle Obstacle::half_space(const Pose& T_base_obstacle, double margin) {
  return make_obstacle(Shape::half_space, 0, 0, T_base_obstacle, margin);
}

Obstacle Obstacle::point_cloud(PointCloud points, double radius, const Pose& T_base_obstacle,
                               double margin) {
  Obstacle obstacle = make_obstacle(Shape::points, radius, 0, T_base_obstacle, margin);
  obstacle.points = std::make_shared<const PointCloud>(std::move(points));
  return obstacle;
}

void Obstacle::validate() const {
  check_place(Pose(pose));
  check_length("margin", margin, true);
  switch (shape) {
    case Shape::box:
      for (const double edge : size) check_length("size", edge, false);
      break;
    case Shape::capsule:
    case Shape::cylinder:
      check_length("length", length, shape == Shape::capsule);
      check_length("radius", radius, false);
      break;
    case Shape::sphere:
      check_length("radius", radius, false);
      break;
    case Shape::points:
      check_length("radius", radius, true);
      if (!points || points->rows() == 0) throw InvalidArgumentError("points: there are none");
      if (!points->allFinite()) throw InvalidArgumentError("points: one is not finite");
      check_size("points", points->cwiseAbs().maxCoeff());
      break;
    case Shape::half_space:
      break;
  }
}

Scene::Scene(const Robot& robot, const RobotSpheres& spheres,
             const std::map<std::string, double>& other_joints)
    : data_(std::make_shared<Data>(robot, spheres, other_joints)) {}

const Robot& Scene::robot() const { return data_->robot; }
const RobotSpheres& Scene::spheres() const { return data_->spheres; }
const std::map<std::string, double>& Scene::other_joints() const { return data_->other_joints; }
const std::map<std::string, Obstacle>& Scene::obstacles() const { return data_->obstacles; }
const std::map<std::string, AttachedObject>& Scene::attached() const { return data_->attached; }

Scene::Data& Scene::own() {
  if (data_.use_count() > 1) data_ = std::make_shared<Data>(*data_);
  return *data_;
}

void Scene::set(const std::string& name, const Obstacle& obstacle) {
  obstacle.validate();
  data_->check_name(name, /*is_obstacle=*/true);
  Data& data = own();
  data.obstacles[name] = obstacle;
  data.lay_out();
}

void Scene::move(const std::string& name, const Pose& T_base_obstacle) {
  const Pose pose = check_place(T_base_obstacle);
  if (data_->obstacles.count(name) == 0) {
    throw_unknown_name("scene: no obstacle '" + name + "'", name, scene_names(*data_));
  }
  Data& data = own();
  data.obstacles[name].pose = StoredPose(pose);
  data.lay_out();
}

void Scene::attach(const std::string& name, const AttachedObject& object) {
  check_spheres(name, object.spheres);
  data_->check_name(name, /*is_obstacle=*/false);
  const auto& links = data_->robot.link_names();
  std::vector<std::string> known(links.begin(), links.end());
  for (const auto& [other, of] : data_->attached) known.push_back(other);
  for (const std::string& other : object.may_touch) {
    if (std::find(known.begin(), known.end(), other) != known.end()) continue;
    throw_unknown_name("may_touch: no link or attached object '" + other + "'", other, known);
  }
  if (std::find(links.begin(), links.end(), object.link) == links.end()) {
    throw_unknown_name("link: the URDF has no link '" + object.link + "'", object.link, links);
  }
  Data& data = own();
  data.attached[name] = object;
  data.attach_all();
}

void Scene::remove(const std::string& name) {
  const bool is_obstacle = data_->obstacles.count(name) > 0;
  if (!is_obstacle && data_->attached.count(name) == 0) {
    throw_unknown_name("scene: nothing has the name '" + name + "'", name, scene_names(*data_));
  }
  Data& data = own();
  if (is_obstacle) {
    data.obstacles.erase(name);
    data.lay_out();
  } else {
    data.attached.erase(name);
    data.attach_all();
  }
}

bool Scene::is_free(const JointVector& q) const {
  check_joints(q, data_->robot.dof(), "q");
  bool free = false;
  find_free(q.data(), 1, &free);
  return free;
}

void Scene::find_free(const double* q, std::size_t count, bool* free) const {
  data_->find_free(q, count, free);
}

std::vector<Contact> Scene::contacts(const JointVector& q) const {
  check_joints(q, data_->robot.dof(), "q");
  return data_->contacts(q);
}

void Scene::check_fits(const Robot& robot) const {
  if (robot.chain_hash() == data_->robot.chain_hash()) return;
  throw InvalidArgumentError("scene: it is of another chain ('" + data_->robot.base_link() +
                             "' to '" + data_->robot.tip_link() + "' of '" + data_->robot.name() +
                             "') than the solver's ('" + robot.base_link() + "' to '" +
                             robot.tip_link() + "' of '" + robot.name() + "')");
}

}  // namespace iksel
