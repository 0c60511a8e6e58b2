// SPDX-License-Identifier: BSD-3-Clause
#include "refine/schemes.hpp"

#include <algorithm>
#include <cmath>

namespace iksel {
JointVector joint_weights(const ChainModel& model, const JointVector& q, double margin) {
  JointVector weights = JointVector::Ones(model.dof);
  for (int i = 0; i < model.dof; ++i) {
    const double range = model.joints.upper[i] - model.joints.lower[i];
    if (!std::isfinite(range)) continue;
    const double s =
        std::min(q[i] - model.joints.lower[i], model.joints.upper[i] - q[i]) / (margin * range);
    if (s <= 0) {
      weights[i] = 0;
    } else if (s < 1) {
      weights[i] = s * s * (3 - 2 * s);
    }
  }
  return weights;
}

namespace {

/// c = -(I - W) phi, phi_i = 0.1 (2 q_i - lo_i - hi_i) / (hi_i - lo_i).
JointVector pull_back(const ChainModel& model, const JointVector& q, const JointVector& weights) {
  JointVector c = JointVector::Zero(model.dof);
  for (int i = 0; i < model.dof; ++i) {
    const double range = model.joints.upper[i] - model.joints.lower[i];
    if (!std::isfinite(range)) continue;
    c[i] = -(1 - weights[i]) * 0.1 * (2 * q[i] - model.joints.lower[i] - model.joints.upper[i]) /
           range;
  }
  return c;
}

}  // namespace

JointVector dls_step(const JacobianMatrix& J, const Vector6& e, const Paper& scheme) {
  if (scheme.damping == 0) return TruncatedSvd(J, scheme.pinv_cutoff).solve(e);
  return damped_solve(J, scheme.damping, e);
}

JointVector pinv_step(const JacobianMatrix& J, const Vector6& e, const Paper& scheme) {
  return TruncatedSvd(J, scheme.pinv_cutoff).inverse() * e;
}

JointVector inverse_step(const ChainModel& model, const JointVector& q, const JacobianMatrix& J,
                         const Vector6& e, const Paper& scheme) {
  const auto step = scheme.iteration == Iteration::dls ? &dls_step : &pinv_step;
  if (scheme.null_space_gain == 0 || model.dof <= 6) return step(J, e, scheme);
  JointVector c = scheme.null_space_gain * (model.joints.middle() - q);
  for (int i = 0; i < model.dof; ++i) {
    if (!std::isfinite(model.joints.upper[i] - model.joints.lower[i])) c[i] = 0;
  }
  return c + step(J, e - J * c, scheme);
}

JointVector cwln_step(const ChainModel& model, const JointVector& q, const JacobianMatrix& J,
                      const Vector6& e, const Paper& scheme) {
  const JointVector weights = joint_weights(model, q, scheme.limit_margin);
  const JointVector c = pull_back(model, q, weights);
  Matrix6 A = J * weights.asDiagonal() * J.transpose();
  A.diagonal().array() += 1e-9;
  const Vector6 y = solve_symmetric(A, e - J * c);
  return c + weights.cwiseProduct(J.transpose() * y);
}

JointVector cwpi_step(const ChainModel& model, const JointVector& q, const JacobianMatrix& J,
                      const Vector6& e, const Paper& scheme) {
  const JointVector weights = joint_weights(model, q, scheme.limit_margin);
  const JointVector c = pull_back(model, q, weights);
  const JointVector root = weights.cwiseSqrt();
  const JacobianMatrix weighted = J * root.asDiagonal();
  const JointVector y = TruncatedSvd(weighted, scheme.pinv_cutoff).solve(e - J * c);
  return c + root.cwiseProduct(y);
}

}  // namespace iksel
