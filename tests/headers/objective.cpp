// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/objective.hpp>

namespace iksel_headers {

void use_objective(const iksel::Robot& robot) {
  const iksel::JointVector zero = iksel::JointVector::Zero(robot.dof());
  iksel::Objective::near_posture(zero, zero).validate(robot.dof());
  iksel::Objective::preferred(robot, {{robot.joint_names()[0], 0.1}}).validate(robot.dof());
  iksel::Objective::far_from_limits().validate(robot.dof());
  iksel::Objective::most_manipulable().validate(robot.dof());
  const auto cost = [](const iksel::JointVector& q) { return q.squaredNorm(); };
  static_cast<void>(iksel::Objective::custom(cost).is_set());
}

}  // namespace iksel_headers
