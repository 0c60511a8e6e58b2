// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/objective.hpp"

#include <utility>

#include "base/message_text.hpp"
#include "iksel/error.hpp"

namespace iksel {

Objective Objective::near_posture(const JointVector& posture, const JointVector& weights) {
  Objective objective;
  objective.kind = Kind::posture;
  objective.posture = posture;
  objective.weights = weights;
  return objective;
}

Objective Objective::far_from_limits() {
  Objective objective;
  objective.kind = Kind::limits;
  return objective;
}

Objective Objective::most_manipulable() {
  Objective objective;
  objective.kind = Kind::manipulability;
  return objective;
}

Objective Objective::custom(std::function<double(const JointVector&)> cost,
                            std::function<JointVector(const JointVector&)> gradient) {
  Objective objective;
  objective.kind = Kind::custom;
  objective.cost = std::move(cost);
  objective.gradient = std::move(gradient);
  return objective;
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
