// SPDX-License-Identifier: BSD-3-Clause
// All joints of several chains brought to all targets at once: the errors of all tips are rows of
// one goal. One seed at a time; the interface is that of search.hpp.
#pragma once

#include "refine/self_motion.hpp"

namespace iksel {

class TipsRefiner {
 public:
  /// `goal` must outlive this.
  TipsRefiner(const Goal& goal, int max_iterations)
      : goal_(goal), max_iterations_(max_iterations) {}

  [[nodiscard]] int width() const { return 1; }
  void load_seed(int /*lane*/, const double* q) {
    q_ = Eigen::Map<const Eigen::VectorXd>(q, goal_.joints().dof());
    // Each chain was solved without what it shares with others.
    if (!goal_.joints().sums.empty()) q_ = goal_.joints().clamp(q_);
  }
  void load_answer(int lane, const double* q) { load_seed(lane, q); }
  /// An attempt from beginning to end. Returns the steps.
  int advance(unsigned /*busy*/) {
    int steps = 0;
    has_arrived_ = converge(goal_, max_iterations_, /*aim=*/1, /*wraps=*/true, q_, steps);
    return steps;
  }
  [[nodiscard]] bool has_arrived(int /*lane*/) const { return has_arrived_; }
  [[nodiscard]] bool is_spent(int /*lane*/) const { return true; }
  static bool stays(int /*lane*/) { return false; }
  [[nodiscard]] bool is_to_be_looked_at(int /*lane*/) const { return false; }
  [[nodiscard]] const JointVector& at(int /*lane*/) const { return q_; }
  [[nodiscard]] const JointVector& q(int /*lane*/) const { return q_; }

 private:
  const Goal& goal_;
  int max_iterations_;
  JointVector q_;
  bool has_arrived_ = false;
};

}  // namespace iksel
