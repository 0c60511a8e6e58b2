// SPDX-License-Identifier: BSD-3-Clause
// One step of Levenberg-Marquardt towards a goal of any number of rows, inside the joint limits.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>

#include "base/pseudo_inverse.hpp"
#include "kinematics/joint_space.hpp"

namespace iksel {

/// As damped_solve in pseudo_inverse.hpp, which six rows go to, for any number of rows: by the
/// smaller of the two systems that give it. Here, because it is seen by few sources.
template <typename Matrix, typename Vector>
JointVector damped_solve(const Matrix& J, double lambda, const Vector& e) {
  constexpr int kMost = Matrix::MaxRowsAtCompileTime;
  using Square =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMost, kMost>;
  const bool by_rows = J.rows() <= J.cols();
  Square A;
  if (by_rows) {
    A.noalias() = J * J.transpose();
  } else {
    A.noalias() = J.transpose() * J;
  }
  A.diagonal().array() += lambda;
  const Eigen::LDLT<Square> factors(A);
  if (by_rows) return J.transpose() * factors.solve(e);
  const Vector gradient = J.transpose() * e;
  return factors.solve(gradient);
}

/// J^T (J J^T + damping I)^-1 e, without what would leave limits that q stands at, and the step cut
/// off at the limits. J and e count lengths in the unit, q and the step do not. `wraps`: joints
/// that turn on and on are brought inside at the end, and are not held.
template <typename Matrix, typename Vector>
JointVector lm_step(const JointSpace& joints, double unit, const JointVector& q, const Matrix& J,
                    const Vector& e, double damping, bool wraps) {
  const auto is_held = [&](int i) { return !(wraps && joints.winds(i)); };
  JointVector pull(joints.dof());
  for (int i = 0; i < joints.dof(); ++i) pull[i] = J.col(i).dot(e);
  const ActiveLimits at = joints.active(q, pull, is_held);
  Matrix active = J;
  for (int i = 0; i < joints.dof(); ++i) {
    if (at.free[i] == 0) active.col(i).setZero();
  }
  if (at.across.cols() > 0) active -= Matrix((active * at.across) * at.across.transpose());
  for (int i = 0; i < joints.dof(); ++i) {
    if (joints.is_slide(i)) active.col(i) *= unit;
  }
  // The floor keeps the solve regular where the error is zero in double precision.
  JointVector step = damped_solve(active, damping + 1e-18, e);
  for (int i = 0; i < joints.dof(); ++i) {
    if (joints.is_slide(i)) step[i] *= unit;
    if (!is_held(i)) continue;
    const double goal = std::min(std::max(q[i] + step[i], joints.lower[i]), joints.upper[i]);
    step[i] = goal - q[i];
  }
  if (joints.sums.empty()) return step;
  JointVector end = q + step;
  joints.hold_sums(end);
  return end - q;
}

/// A step into the bounds of a LinearGoal, made by `step(rows, asked)`. Rows inside their bounds
/// ask for nothing, unless the step would take them out: then they are to stay at the bound.
template <typename Linear, typename Step>
JointVector step_into_bounds(const Linear& at, const Step& step) {
  constexpr int kRounds = 3;
  typename Linear::Vector asked = at.missing;
  typename Linear::Jacobian rows = at.J;
  bool active[Linear::Vector::MaxRowsAtCompileTime];
  for (int i = 0; i < at.J.rows(); ++i) {
    active[i] = at.missing[i] != 0 || at.is_fixed(i);
    if (!active[i]) rows.row(i).setZero();
  }
  for (int round = 0;; ++round) {
    JointVector adjustment = step(rows, asked);
    if (round == kRounds) return adjustment;
    bool changed = false;
    for (int i = 0; i < at.J.rows(); ++i) {
      if (active[i]) continue;
      const double end = at.deviation[i] + at.J.row(i).dot(adjustment);
      if (end >= at.lower[i] && end <= at.upper[i]) continue;
      active[i] = true;
      changed = true;
      rows.row(i) = at.J.row(i);
      asked[i] = (end < at.lower[i] ? at.lower[i] : at.upper[i]) - at.deviation[i];
    }
    if (!changed) return adjustment;
  }
}

}  // namespace iksel
