// SPDX-License-Identifier: BSD-3-Clause
// All joints of several chains brought to all targets at once: Levenberg-Marquardt with the limits
// inside the step, on the errors of all tips one below the other. One seed at a time; the interface
// is that of search.hpp.
#pragma once

#include "tree/stacked_goal.hpp"

namespace iksel {

/// The step that takes `missing` away, lower <= q + step <= upper: J^T (J J^T + damping I)^-1
/// missing, with the columns of joints that stand at a limit and would leave it set to zero, cut
/// off at the limits.
JointVector stacked_step(const JointSpace& joints, const JointVector& q, const StackedJacobian& J,
                         const StackedVector& missing, double damping);

/// W J^T (J W J^T)^+ missing for W = diag(weights): of all steps that take `missing` away the
/// least, measured by 1 / weights.
JointVector weighted_solve(const StackedJacobian& J, const JointVector& weights,
                           const StackedVector& missing);

class StackedRefiner {
 public:
  /// All must outlive this.
  StackedRefiner(const StackedGoal& goal, int max_iterations)
      : goal_(goal), max_iterations_(max_iterations) {}

  [[nodiscard]] int width() const { return 1; }
  void load_seed(int /*lane*/, const double* q) {
    q_ = Eigen::Map<const Eigen::VectorXd>(q, goal_.model().dof());
  }
  /// An attempt from beginning to end. Returns the steps.
  int advance(unsigned busy);
  [[nodiscard]] bool has_arrived(int /*lane*/) const { return has_arrived_; }
  [[nodiscard]] bool is_spent(int /*lane*/) const { return true; }
  static bool stays(int /*lane*/) { return false; }
  [[nodiscard]] bool is_to_be_looked_at(int /*lane*/) const { return false; }
  [[nodiscard]] const JointVector& at(int /*lane*/) const { return q_; }
  [[nodiscard]] const JointVector& q(int /*lane*/) const { return q_; }

  /// Brings q to the goal, to `aim` of the tolerances where that can be had in at most `most`
  /// steps; adds the steps. False if it does not get within the tolerances.
  static bool converge(const StackedGoal& goal, int most, double aim, JointVector& q, int& steps);

 private:
  const StackedGoal& goal_;
  int max_iterations_;
  JointVector q_;
  bool has_arrived_ = false;
};

}  // namespace iksel
