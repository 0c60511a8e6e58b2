// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/objective.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/message_text.hpp"
#include "iksel/error.hpp"

namespace iksel {
namespace {

/// The place of a joint named in `what`.
Eigen::Index index_of_joint(const Robot& robot, const std::string& name, const char* what) {
  const std::vector<std::string>& names = robot.joint_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return found - names.begin();
  throw_unknown_name(
      std::string(what) + ": robot '" + robot.name() + "' has no joint '" + name + "' on its chain",
      name, names);
}

}  // namespace

Objective Objective::near_posture(const JointVector& posture, const JointVector& weights) {
  return {Kind::posture, posture, weights, {}, {}};
}

Objective Objective::preferred(const Robot& robot, const std::map<std::string, double>& values,
                               const std::map<std::string, double>& weights) {
  if (values.empty()) throw InvalidArgumentError("preferred values: they name no joint");
  JointVector posture(robot.dof());
  for (Eigen::Index j = 0; j < posture.size(); ++j) {
    const double middle = 0.5 * (robot.lower()[j] + robot.upper()[j]);
    posture[j] = std::isfinite(middle) ? middle : 0.0;
  }
  JointVector of_posture = JointVector::Zero(robot.dof());
  for (const auto& [name, value] : values) {
    const Eigen::Index j = index_of_joint(robot, name, "preferred values");
    posture[j] = value;
    of_posture[j] = 1;
  }
  for (const auto& [name, weight] : weights) {
    const Eigen::Index j = index_of_joint(robot, name, "preferred weights");
    if (of_posture[j] == 0) {
      throw InvalidArgumentError("preferred weights: joint '" + name + "' has no preferred value");
    }
    if (!(weight > 0 && std::isfinite(weight))) {
      throw InvalidArgumentError("preferred weights: that of joint '" + name + "' is " +
                                 number_text(weight) + ", not above 0");
    }
    of_posture[j] = weight;
  }
  Objective objective = near_posture(posture, of_posture);
  objective.validate(robot.dof());
  return objective;
}

Objective Objective::far_from_limits() { return {Kind::limits, {}, {}, {}, {}}; }

Objective Objective::most_manipulable() { return {Kind::manipulability, {}, {}, {}, {}}; }

Objective Objective::custom(std::function<double(const JointVector&)> cost,
                            std::function<JointVector(const JointVector&)> gradient) {
  return {Kind::custom, {}, {}, std::move(cost), std::move(gradient)};
}

void Objective::validate(int dof) const {
  if (kind == Kind::custom && !cost) {
    throw InvalidArgumentError("objective: a custom one needs a cost");
  }
  if (kind != Kind::posture) return;
  check_joints(posture, dof, "objective posture");
  if (weights.size() == 0) return;
  check_joints(weights, dof, "objective weights");
  if (weights.minCoeff() < 0 || weights.maxCoeff() == 0) {
    throw InvalidArgumentError("objective weights: they are not all 0 or more, or all are 0");
  }
}

}  // namespace iksel
