// SPDX-License-Identifier: BSD-3-Clause
// The configuration inside the limits from which the least is missing of a goal, near a seed.
#pragma once

#include "goal/goal.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

/// How far a configuration is from a goal: half the squared length of what is missing, each part of
/// it times its weight.
class Remainder {
 public:
  /// `weights` of position [1/m] and rotation [1/rad] along the axes of the task. All must outlive
  /// this.
  Remainder(const ChainModel& model, const Goal& goal, const Vector6& weights)
      : model_(model), goal_(goal), weights2_(weights.cwiseAbs2()) {}

  [[nodiscard]] double value(const JointVector& q) const;
  /// Also its gradient, and the Gauss-Newton approximation's diagonal of the second derivative.
  double value(const JointVector& q, JointVector& gradient, JointVector& diagonal) const;

 private:
  const ChainModel& model_;
  const Goal& goal_;
  Vector6 weights2_;
};

/// Moves q, inside the limits, to a local minimum in at most `most` steps, by Newton's method with
/// the limits as an active set (Bertsekas: "Projected Newton methods", SIAM J. Control and
/// Optimization 20, 1982) and damped as Levenberg-Marquardt. Returns the remainder there; `steps`
/// counts those taken.
double descend_to_closest(const ChainModel& model, const Remainder& remainder, int most,
                          JointVector& q, int& steps);

}  // namespace iksel
