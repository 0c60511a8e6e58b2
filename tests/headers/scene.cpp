// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/scene.hpp>

namespace iksel_headers {

void use_scene(const iksel::Robot& robot, const iksel::Pose& pose) {
  iksel::Scene scene(robot, iksel::RobotSpheres());
  scene.set("a", iksel::Obstacle::sphere(0.1, pose));
  scene.set("b", iksel::Obstacle::box({0.1, 0.1, 0.1}, pose));
  scene.set("c", iksel::Obstacle::capsule(0.1, 0.1, pose));
  scene.set("d", iksel::Obstacle::cylinder(0.1, 0.1, pose));
  scene.set("e", iksel::Obstacle::half_space(pose));
  scene.set("f", iksel::Obstacle::point_cloud(iksel::PointCloud(), 0.1, pose));
  scene.move("a", pose);
  scene.attach("g", iksel::AttachedObject());
  scene.remove("b");
  scene.check_fits(scene.robot());
  scene.obstacles().begin()->second.validate();
  static_cast<void>(to_string(iksel::Obstacle::Shape::box));
  static_cast<void>(scene.spheres().links.size() + scene.other_joints().size());
  const iksel::JointVector q = robot.lower();
  bool free = scene.is_free(q) && scene.attached().empty() && scene.contacts(q).empty();
  scene.find_free(q.data(), 1, &free);
}

}  // namespace iksel_headers
