// SPDX-License-Identifier: BSD-3-Clause
// An Objective as descents along self-motions need it: value, gradient, and a diagonal second
// derivative.
#pragma once

#include "iksel/objective.hpp"
#include "kinematics/robot_model.hpp"

namespace iksel {

/// sqrt(det(J J^T)), or sqrt(det(J^T J)) where there are fewer joints than rows (Yoshikawa 1985);
/// of several tips with the rows of all.
double manipulability(const RobotModel& model, const JointVector& q);

/// For one descent: where the second derivative is not known, it is estimated from the gradients
/// that were asked for so far (Barzilai and Borwein 1988).
class ObjectiveCost {
 public:
  /// Both must outlive this.
  ObjectiveCost(const RobotModel& model, const Objective& objective)
      : model_(model), objective_(objective) {}

  [[nodiscard]] double value(const JointVector& q) const { return (*this)(q, nullptr, nullptr); }
  double operator()(const JointVector& q, JointVector* gradient, JointVector* curvature) const;

 private:
  double of_posture(const JointVector& q, JointVector* gradient, JointVector* curvature) const;
  double of_limits(const JointVector& q, JointVector* gradient, JointVector* curvature) const;
  /// Throws InvalidArgumentError about NaN and -infinity.
  [[nodiscard]] double of_custom(const JointVector& q) const;
  [[nodiscard]] JointVector slope(const JointVector& q) const;
  [[nodiscard]] double estimate_curvature(const JointVector& q, const JointVector& gradient) const;

  const RobotModel& model_;
  const Objective& objective_;
  mutable JointVector last_q_, last_gradient_;
  mutable double last_curvature_ = 0;
};

}  // namespace iksel
