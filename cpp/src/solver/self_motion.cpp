// SPDX-License-Identifier: BSD-3-Clause
#include "solver/self_motion.hpp"

#include <algorithm>
#include <cmath>

#include "iteration/iterate.hpp"
#include "iteration/schemes.hpp"

namespace iksel {
namespace {

/// The part of the step d = -H^-1 g that keeps the pose to first order: d - H^-1 J^T (J H^-1
/// J^T)^-1 J d, over the joints that may move (Newton's step for the cost under the constraint
/// J d = 0).
JointVector project(const JacobianMatrix& J, const JointVector& inverse_curvature,
                    const JointVector& d) {
  const JacobianMatrix weighted = J * inverse_curvature.asDiagonal();
  Matrix6 A = weighted * J.transpose();
  A.diagonal().array() += 1e-12 * std::max(A.trace(), 1e-12);
  return d - weighted.transpose() * A.ldlt().solve(J * d);
}

/// The step from q, with the joints held that it would push over a limit.
JointVector make_slide_step(const ChainModel& model, const JointVector& q, const Jacobian& J,
                            const JointVector& gradient, const JointVector& curvature) {
  JointVector free = JointVector::Ones(model.dof);
  const JointVector inverse = curvature.cwiseInverse();
  JointVector step = JointVector::Zero(model.dof);
  for (int round = 0; round <= model.dof; ++round) {
    const JointVector weight = inverse.cwiseProduct(free);
    step = project(J, weight, -weight.cwiseProduct(gradient));
    bool held = false;
    for (int j = 0; j < model.dof; ++j) {
      if (free[j] == 0) continue;
      constexpr double kAt = 1e-9;
      if ((step[j] < 0 && q[j] <= model.lower[j] + kAt) ||
          (step[j] > 0 && q[j] >= model.upper[j] - kAt)) {
        free[j] = 0;
        held = true;
      }
    }
    if (!held) break;
  }
  return step;
}

void clamp(const ChainModel& model, JointVector& q) {
  q = q.cwiseMax(model.lower).cwiseMin(model.upper);
}

}  // namespace

bool converge(const ChainModel& model, const SolverOptions& options, const Pose& T_base_tip,
              int most, JointVector& q) {
  Pose pose;
  Jacobian J;
  // The default damping, whatever the scheme of the solver is.
  const SolverOptions damped;
  for (int i = 0;; ++i) {
    model.fk_jacobian(q.data(), pose, J);
    const Vector6 e = pose_error(T_base_tip, pose);
    const double position = e.head<3>().norm();
    const double rotation = e.tail<3>().norm();
    if (i == most || (position <= 0.01 * options.position_tolerance &&
                      rotation <= 0.01 * options.rotation_tolerance)) {
      return position <= options.position_tolerance && rotation <= options.rotation_tolerance &&
             model.within_limits(q.data());
    }
    q += lm_step(model, q, J, e, damped);
    if (!q.allFinite()) return false;
  }
}

int slide(const ChainModel& model, const SolverOptions& options, const Pose& T_base_tip,
          const JointCost& cost, int most, JointVector& q) {
  /// Longest step of a joint, within which the pose stays near enough to be corrected [rad or m].
  constexpr double kLongest = 0.5;
  constexpr double kSettled = 1e-7;
  constexpr int kCorrections = 8;
  JointVector gradient(model.dof);
  JointVector curvature(model.dof);
  Pose pose;
  Jacobian J;
  double value = cost(q, &gradient, &curvature);
  int steps = 0;
  while (steps < most) {
    model.fk_jacobian(q.data(), pose, J);
    const JointVector step = make_slide_step(model, q, J, gradient, curvature);
    const double longest = step.cwiseAbs().maxCoeff();
    if (!(longest > kSettled)) return steps;
    double scale = std::min(1.0, kLongest / longest);
    bool better = false;
    for (int halving = 0; halving < 8 && !better; ++halving, scale /= 2) {
      JointVector next = q + scale * step;
      clamp(model, next);
      if (!converge(model, options, T_base_tip, kCorrections, next)) continue;
      const double next_value = cost(next, nullptr, nullptr);
      if (!(next_value < value)) continue;
      better = true;
      q = next;
    }
    ++steps;
    if (!better) return steps;
    value = cost(q, &gradient, &curvature);
  }
  return steps;
}

}  // namespace iksel
