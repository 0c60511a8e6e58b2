// SPDX-License-Identifier: BSD-3-Clause
#include "refine/closest_descent.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace iksel {
namespace {

using SquareMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, kMaxDof, kMaxDof>;

/// Longest step of a joint [rad or m].
constexpr double kLongestDescent = 0.5;

/// The second derivative by differences of the gradient, which cost less than its formula: that has
/// the task's swing and twist in it.
SquareMatrix second_derivative(const Remainder& remainder, const JointVector& q,
                               const JointVector& gradient) {
  constexpr double kDifference = 1e-6;
  const auto n = q.size();
  SquareMatrix H(n, n);
  JointVector moved = q;
  JointVector there(n);
  JointVector ignored(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    moved[j] = q[j] + kDifference;
    remainder.value(moved, there, ignored);
    H.col(j) = (there - gradient) / kDifference;
    moved[j] = q[j];
  }
  return 0.5 * (H + SquareMatrix(H.transpose()));
}

/// Leaves out joints that stand at a limit and would go beyond: returns whether any is left.
bool hold_at_limits(const JointSpace& joints, const JointVector& q, JointVector& gradient,
                    SquareMatrix& H) {
  JointVector free = JointVector::Ones(q.size());
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const bool leaves = (q[j] <= joints.lower[j] && gradient[j] > 0) ||
                        (q[j] >= joints.upper[j] && gradient[j] < 0);
    if (!leaves) continue;
    gradient[j] = 0;
    H.row(j).setZero();
    H.col(j).setZero();
    H(j, j) = 1;
    free[j] = 0;
  }
  if (!joints.coupled.empty()) {
    // The same for directions across coupled limits.
    const CoupledNormals N = joints.coupled_normals(q, -gradient, free);
    const SquareMatrix across = N * N.transpose();
    const SquareMatrix along = SquareMatrix::Identity(q.size(), q.size()) - across;
    gradient = JointVector(along * gradient);
    H = SquareMatrix(along * H * along + across);
  }
  return !gradient.isZero(0);
}

}  // namespace

double Remainder::value(const JointVector& q) const {
  const Vector6 d = goal_.task().deviation(goal_.target(), model_.fk(q.data()));
  const Vector6 outside = goal_.task().outside(d);
  return 0.5 * outside.dot(weights2_.cwiseProduct(outside));
}

double Remainder::value(const JointVector& q, JointVector& gradient, JointVector& diagonal) const {
  Pose pose;
  Jacobian of_pose;
  model_.fk_jacobian(q.data(), pose, of_pose);
  JacobianMatrix J = of_pose;
  const Vector6 d = goal_.task().deviation(goal_.target(), pose, J);
  const Vector6 outside = goal_.task().outside(d);
  Vector6 active = weights2_;
  for (int i = 0; i < 6; ++i) {
    if (outside[i] == 0 && goal_.task().lower()[i] < goal_.task().upper()[i]) active[i] = 0;
  }
  const Vector6 weighted = weights2_.cwiseProduct(outside);
  gradient = J.transpose() * weighted;
  diagonal = J.cwiseAbs2().transpose() * active;
  return 0.5 * outside.dot(weighted);
}

double descend_to_closest(const ChainModel& model, const Remainder& remainder, int most,
                          JointVector& q, int& steps) {
  constexpr double kSettled = 1e-9;
  constexpr double kLeastDamping = 1e-10;
  constexpr double kMostDamping = 1e6;
  JointVector gradient(model.dof);
  JointVector diagonal(model.dof);
  double value = remainder.value(q, gradient, diagonal);
  double damping = 1e-4;
  for (int taken = 0; taken < most; ++taken) {
    SquareMatrix H = second_derivative(remainder, q, gradient);
    if (!hold_at_limits(model.joints, q, gradient, H)) return value;
    const JointVector scale = diagonal.array() + 1e-6 * diagonal.maxCoeff() + 1e-12;
    bool is_better = false;
    double longest = 0;
    for (; damping <= kMostDamping && !is_better; damping *= 10) {
      SquareMatrix damped = H;
      damped.diagonal() += damping * scale;
      const Eigen::LLT<SquareMatrix> factors(damped);
      if (factors.info() != Eigen::Success) continue;
      JointVector step = -factors.solve(gradient);
      longest = step.cwiseAbs().maxCoeff();
      if (longest > kLongestDescent) step *= kLongestDescent / longest;
      const JointVector next = model.joints.clamp(q + step);
      if (!(remainder.value(next) < value)) continue;
      is_better = true;
      q = next;
    }
    if (!is_better) return value;
    ++steps;
    damping = std::max(damping * 1e-3, kLeastDamping);
    const double before = value;
    value = remainder.value(q, gradient, diagonal);
    if (longest < kSettled || before - value <= 1e-9 * value) return value;
  }
  return value;
}

}  // namespace iksel
