// SPDX-License-Identifier: BSD-3-Clause
#include "tree/stacked_refiner.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace iksel {
namespace {

/// Rows and columns of either.
using StackedSquare =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxRows, kMaxRows>;

/// J^T (J J^T + damping I)^-1 e, by the smaller of the two systems that give it.
JointVector damped_stacked_solve(const StackedJacobian& J, double damping, const StackedVector& e) {
  // The floor keeps the solve regular where the error is zero in double precision.
  constexpr double kFloor = 1e-18;
  const bool by_rows = J.rows() <= J.cols();
  StackedSquare A;
  if (by_rows) {
    A.noalias() = J * J.transpose();
  } else {
    A.noalias() = J.transpose() * J;
  }
  A.diagonal().array() += damping + kFloor;
  const Eigen::LDLT<StackedSquare> factors(A);
  if (by_rows) return J.transpose() * factors.solve(e);
  const StackedVector gradient = J.transpose() * e;
  return factors.solve(gradient);
}

/// The errors that a step is to take away: where a tip is inside its task's box, only what would
/// take it out again.
JointVector step_into_boxes(const StackedGoal& goal, const JointVector& q, const StackedVector& d,
                            const StackedVector& e, const StackedJacobian& J) {
  constexpr double kDamping = 1e-3;
  constexpr int kRounds = 3;
  const JointSpace& joints = goal.model().joints;
  const double damping = kDamping * e.squaredNorm();
  StackedVector asked = e;
  StackedJacobian rows = J;
  const auto is_free = [&](Eigen::Index i) {
    return e[i] == 0 && goal.aim_lower()[i] != goal.aim_upper()[i];
  };
  for (Eigen::Index i = 0; i < e.size(); ++i) {
    if (is_free(i)) rows.row(i).setZero();
  }
  for (int round = 0;; ++round) {
    JointVector step = stacked_step(joints, q, rows, asked, damping);
    bool changed = false;
    for (Eigen::Index i = 0; i < e.size() && round < kRounds; ++i) {
      if (!is_free(i) || asked[i] != 0) continue;
      const double end = d[i] + J.row(i).dot(step);
      const double bounded = std::min(std::max(end, goal.aim_lower()[i]), goal.aim_upper()[i]);
      if (bounded == end) continue;
      asked[i] = bounded - d[i];
      rows.row(i) = J.row(i);
      changed = true;
    }
    if (!changed) return step;
  }
}

}  // namespace

JointVector stacked_step(const JointSpace& joints, const JointVector& q, const StackedJacobian& J,
                         const StackedVector& missing, double damping) {
  StackedJacobian active = J;
  for (int i = 0; i < joints.dof(); ++i) {
    if (joints.is_periodic(i)) continue;
    const double gradient = J.col(i).dot(missing);
    if ((q[i] <= joints.lower[i] && gradient < 0) || (q[i] >= joints.upper[i] && gradient > 0)) {
      active.col(i).setZero();
    }
  }
  JointVector step = damped_stacked_solve(active, damping, missing);
  for (int i = 0; i < joints.dof(); ++i) {
    if (joints.is_periodic(i)) continue;
    step[i] = std::min(std::max(q[i] + step[i], joints.lower[i]), joints.upper[i]) - q[i];
  }
  return step;
}

JointVector weighted_solve(const StackedJacobian& J, const JointVector& weights,
                           const StackedVector& missing) {
  const StackedJacobian weighted = J * weights.asDiagonal();
  StackedSquare A;
  A.noalias() = weighted * J.transpose();
  A.diagonal().array() += 1e-12 * std::max(A.trace(), 1e-12);
  return weighted.transpose() * Eigen::LDLT<StackedSquare>(A).solve(missing);
}

bool StackedRefiner::converge(const StackedGoal& goal, int most, double aim, JointVector& q,
                              int& steps) {
  StackedVector d;
  StackedJacobian J;
  for (int step = 0;; ++step) {
    goal.linearize(q, d, J);
    const StackedVector e = d.cwiseMax(goal.aim_lower()).cwiseMin(goal.aim_upper()) - d;
    if (goal.is_reached(e, step == most ? 1 : aim)) break;
    if (step == most) return false;
    const JointVector adjustment = step_into_boxes(goal, q, d, e, J);
    ++steps;
    if (!adjustment.allFinite()) return false;
    q += adjustment;
  }
  goal.model().joints.wrap(q.data());
  return true;
}

int StackedRefiner::advance(unsigned /*busy*/) {
  int steps = 0;
  has_arrived_ = converge(goal_, max_iterations_, 1, q_, steps);
  return steps;
}

}  // namespace iksel
