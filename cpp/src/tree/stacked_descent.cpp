// SPDX-License-Identifier: BSD-3-Clause
#include "tree/stacked_descent.hpp"

#include <algorithm>

#include "tree/stacked_refiner.hpp"

namespace iksel {
namespace {

/// The step that makes a cost least to second order (gradient, diagonal second derivative) while
/// the tips stay inside their tasks and the joints inside their limits. Bounds that the step would
/// leave are held one after another, and stay held: what that loses, the next step makes good.
class StackedDescentStep {
 public:
  StackedDescentStep(const StackedGoal& goal, const JointVector& q, const JointVector& gradient,
                     const JointVector& curvature)
      : goal_(goal),
        q_(q),
        unbound_(-gradient.cwiseQuotient(curvature)),
        inverse_(curvature.cwiseInverse()) {
    goal.linearize(q, d_, J_);
    held_.setZero(q.size());
    asked_.setZero(d_.size());
    is_active_.resize(d_.size());
    for (Eigen::Index i = 0; i < d_.size(); ++i) {
      is_active_[i] = goal.aim_lower()[i] == goal.aim_upper()[i];
    }
  }

  JointVector solve() {
    JointVector step = step_on_active();
    const Eigen::Index most = q_.size() + d_.size();
    for (Eigen::Index round = 0; round < most && hold_what_leaves(step); ++round) {
      step = step_on_active();
    }
    return step;
  }

 private:
  /// The nearest to the unbound step, by the curvature, with the held joints where they are held
  /// and the active rows as asked.
  [[nodiscard]] JointVector step_on_active() const {
    JointVector weights = inverse_;
    JointVector start = unbound_;
    for (Eigen::Index j = 0; j < q_.size(); ++j) {
      if (held_[j] == 0) continue;
      weights[j] = 0;
      start[j] = (held_[j] < 0 ? joints().lower : joints().upper)[j] - q_[j];
    }
    StackedJacobian rows = J_;
    StackedVector missing = asked_ - J_ * start;
    for (Eigen::Index i = 0; i < d_.size(); ++i) {
      if (is_active_[i]) continue;
      rows.row(i).setZero();
      missing[i] = 0;
    }
    return start + weighted_solve(rows, weights, missing);
  }

  /// Holds joints and rows that the step takes beyond their bounds; false if there are none.
  bool hold_what_leaves(const JointVector& step) {
    bool any = false;
    for (int j = 0; j < joints().dof(); ++j) {
      if (held_[j] != 0) continue;
      const double end = q_[j] + step[j];
      held_[j] = end < joints().lower[j] ? -1 : end > joints().upper[j] ? 1 : 0;
      any = any || held_[j] != 0;
    }
    for (Eigen::Index i = 0; i < d_.size(); ++i) {
      if (is_active_[i]) continue;
      const double end = d_[i] + J_.row(i).dot(step);
      const double bounded = std::min(std::max(end, goal_.aim_lower()[i]), goal_.aim_upper()[i]);
      if (end == bounded) continue;
      is_active_[i] = true;
      asked_[i] = bounded - d_[i];
      any = true;
    }
    return any;
  }

  [[nodiscard]] const JointSpace& joints() const { return goal_.model().joints; }

  const StackedGoal& goal_;
  const JointVector& q_;
  JointVector unbound_, inverse_;
  StackedVector d_, asked_;
  StackedJacobian J_;
  /// -1 at the lower limit, 1 at the upper, 0 neither.
  JointVector held_;
  Eigen::Array<bool, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxRows, 1> is_active_;
};

int descend(const StackedGoal& goal, const MoveCost& cost, int most, JointVector& q) {
  /// Longest step of a joint, within which the poses stay near enough to be corrected [rad or m].
  constexpr double kLongest = 0.5;
  constexpr double kSettled = 1e-7;
  constexpr int kCorrections = 8;
  constexpr int kHalvings = 8;
  const JointSpace& joints = goal.model().joints;
  JointVector gradient(joints.dof());
  JointVector curvature(joints.dof());
  int steps = 0;
  while (steps < most) {
    const double value = cost(q, &gradient, &curvature);
    const JointVector step = StackedDescentStep(goal, q, gradient, curvature).solve();
    const double longest = step.cwiseAbs().maxCoeff();
    ++steps;
    if (!(longest > kSettled)) return steps;
    double scale = std::min(1.0, kLongest / longest);
    bool better = false;
    for (int halving = 0; halving < kHalvings && !better; ++halving, scale /= 2) {
      JointVector next = joints.clamp(q + scale * step);
      if (!StackedRefiner::converge(goal, kCorrections, 0.01, next, steps)) continue;
      if (!joints.contains(next.data()) || !(cost(next, nullptr, nullptr) < value)) continue;
      better = true;
      q = next;
    }
    if (!better) return steps;
  }
  return steps;
}

}  // namespace

int descend_to_near(const StackedGoal& goal, const JointMove& move, const JointVector& near,
                    JointVector& q) {
  constexpr int kSteps = 20;
  int steps = descend(goal, MoveCost(move.weights(), near), kSteps, q);
  if (move.norm() == MoveNorm::two) return steps;
  JointVector best = q;
  // The p-norm tends to the max norm; each is easy to reach from the one before.
  for (const double power : {4.0, 16.0, 64.0}) {
    steps += descend(goal, MoveCost(move.weights(), near, power), kSteps, q);
    if (move.length(q - near) < move.length(best - near)) best = q;
  }
  q = best;
  return steps;
}

}  // namespace iksel
