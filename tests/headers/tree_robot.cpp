// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/tree_robot.hpp>

namespace iksel_headers {

void use_tree_robot(const std::filesystem::path& path) {
  const auto robot = iksel::TreeRobot::from_urdf_file(path, iksel::TreeOptions());
  const auto other = iksel::TreeRobot::from_urdf_string(robot.urdf(), robot.options());
  const iksel::JointVector& q = other.lower();
  static_cast<void>(robot.name() + robot.base_link() + robot.tip_links()[0]);
  static_cast<void>(robot.tips() + robot.dof() + robot.chain(0).dof());
  static_cast<void>(robot.joint_names().size() + robot.joint_types().size());
  static_cast<void>(robot.joints_of(0).size() + robot.shared_joints().size());
  static_cast<void>(robot.upper().size() + robot.velocity_limit().size());
  static_cast<void>(robot.within_limits(q) && robot.fk(q).empty());
  static_cast<void>(robot.jacobian(q).size() + robot.random_configurations(1, 1).size());
}

}  // namespace iksel_headers
