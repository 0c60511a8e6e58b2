// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/robot.hpp>

namespace iksel_headers {

void use_robot(const std::filesystem::path& path) {
  const auto robot = iksel::Robot::from_urdf_file(path);
  const auto other = iksel::Robot::from_urdf_string(robot.urdf(), robot.options());
  const iksel::JointVector q = other.with_tcp(robot.tcp()).without_limits().lower();
  static_cast<void>(robot.name() + robot.base_link() + robot.tip_link());
  static_cast<void>(robot.link_names().size() + robot.joint_names().size());
  static_cast<void>(robot.joint_types().size() + robot.chain_hash());
  static_cast<void>(robot.upper().size() + robot.velocity_limit().size() + robot.dof());
  static_cast<void>(robot.soft_lower().size() + robot.soft_upper().size());
  static_cast<void>(robot.within_limits(q));
  static_cast<void>(robot.fk(q).matrix() * robot.jacobian(q, iksel::Kinematics::kdl)(0, 0));
  std::vector<double> T_base_link(16 * robot.link_poses(q).size());
  robot.link_poses(q.data(), 1, {}, T_base_link.data());
  static_cast<void>(robot.inverse_jacobian(q, 0.1) * robot.random_configurations(1, 1).transpose());
  static_cast<void>(robot.reach() + robot.reach_centre().norm());
}

}  // namespace iksel_headers
