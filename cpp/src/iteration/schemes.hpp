// SPDX-License-Identifier: BSD-3-Clause
// One step of each iteration scheme: the joint adjustment for an error e at q (paper, Table II).
#pragma once

#include <Eigen/Cholesky>
#include <cmath>

#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"
#include "math/constants.hpp"
#include "math/pseudo_inverse.hpp"

namespace iksel {

/// dls: J^T (J J^T + damping I)^-1 e; truncated least squares in the undamped limit.
inline JointVector dls_step(const JacobianMatrix& J, const Vector6& e,
                            const SolverOptions& options) {
  if (options.damping == 0) return TruncatedSvd(J, options.pinv_cutoff).solve(e);
  return damped_solve(J, options.damping, e);
}

/// pinv, pinv_rr: J^+ e.
inline JointVector pinv_step(const JacobianMatrix& J, const Vector6& e,
                             const SolverOptions& options) {
  return TruncatedSvd(J, options.pinv_cutoff).inverse() * e;
}

/// Weight of each joint in cwln and cwpi: 1 inside, falling as 3 s^2 - 2 s^3 to 0 over the margin
/// at each end of the range, s the distance to the limit over the margin (Huang et al. 2016).
inline JointVector joint_weights(const ChainModel& model, const JointVector& q, double margin) {
  JointVector weights = JointVector::Ones(model.dof);
  for (int i = 0; i < model.dof; ++i) {
    const double range = model.upper[i] - model.lower[i];
    if (!std::isfinite(range)) continue;
    const double s = std::min(q[i] - model.lower[i], model.upper[i] - q[i]) / (margin * range);
    if (s <= 0) {
      weights[i] = 0;
    } else if (s < 1) {
      weights[i] = s * s * (3 - 2 * s);
    }
  }
  return weights;
}

/// Pull-back towards mid-range, c = -(I - W) phi, phi_i = 0.1 (2 q_i - lo_i - hi_i) / (hi_i -
/// lo_i).
inline JointVector pull_back(const ChainModel& model, const JointVector& q,
                             const JointVector& weights) {
  constexpr double kGain = 0.1;
  JointVector c = JointVector::Zero(model.dof);
  for (int i = 0; i < model.dof; ++i) {
    const double range = model.upper[i] - model.lower[i];
    if (!std::isfinite(range)) continue;
    c[i] = -(1 - weights[i]) * kGain * (2 * q[i] - model.lower[i] - model.upper[i]) / range;
  }
  return c;
}

/// cwln: c + W J^T (J W J^T + 1e-9 I)^-1 (e - J c).
inline JointVector cwln_step(const ChainModel& model, const JointVector& q, const JacobianMatrix& J,
                             const Vector6& e, const SolverOptions& options) {
  constexpr double kDamping = 1e-9;
  const JointVector weights = joint_weights(model, q, options.limit_margin);
  const JointVector c = pull_back(model, q, weights);
  Matrix6 A = J * weights.asDiagonal() * J.transpose();
  A.diagonal().array() += kDamping;
  const Vector6 y = A.ldlt().solve(e - J * c);
  return c + weights.cwiseProduct(J.transpose() * y);
}

/// cwpi: c + W^1/2 (J W^1/2)^+ (e - J c).
inline JointVector cwpi_step(const ChainModel& model, const JointVector& q, const JacobianMatrix& J,
                             const Vector6& e, const SolverOptions& options) {
  const JointVector weights = joint_weights(model, q, options.limit_margin);
  const JointVector c = pull_back(model, q, weights);
  const JointVector root = weights.cwiseSqrt();
  const JacobianMatrix weighted = J * root.asDiagonal();
  const JointVector y = TruncatedSvd(weighted, options.pinv_cutoff).solve(e - J * c);
  return c + root.cwiseProduct(y);
}

/// True where a joint has limits that count: a range of 2 pi or more is left free and wrapped
/// later.
inline bool limits_count(const ChainModel& model, int i) {
  return model.joint_types[static_cast<std::size_t>(i)] == JointType::prismatic ||
         model.upper[i] - model.lower[i] < kTwoPi;
}

/// lm: J^T (J J^T + damping |e|^2 I)^-1 e, or with `squared_error` in place of |e|^2, with the
/// columns of joints that stand at a limit and would leave it set to zero, and the step cut off at
/// the limits.
inline JointVector lm_step(const ChainModel& model, const JointVector& q, const JacobianMatrix& J,
                           const Vector6& e, const SolverOptions& options, double squared_error) {
  JacobianMatrix active = J;
  for (int i = 0; i < model.dof; ++i) {
    if (!limits_count(model, i)) continue;
    const double gradient = J.col(i).dot(e);
    if ((q[i] <= model.lower[i] && gradient < 0) || (q[i] >= model.upper[i] && gradient > 0)) {
      active.col(i).setZero();
    }
  }
  // The floor keeps the solve regular where the error is zero in double precision.
  const double lambda = options.damping * squared_error + 1e-18;
  JointVector step = damped_solve(active, lambda, e);
  for (int i = 0; i < model.dof; ++i) {
    if (!limits_count(model, i)) continue;
    const double goal = std::min(std::max(q[i] + step[i], model.lower[i]), model.upper[i]);
    step[i] = goal - q[i];
  }
  return step;
}

inline JointVector lm_step(const ChainModel& model, const JointVector& q, const JacobianMatrix& J,
                           const Vector6& e, const SolverOptions& options) {
  return lm_step(model, q, J, e, options, e.squaredNorm());
}

}  // namespace iksel
