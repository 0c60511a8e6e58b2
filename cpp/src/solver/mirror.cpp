// SPDX-License-Identifier: BSD-3-Clause
#include "solver/mirror.hpp"

#include <cmath>

#include "math/pseudo_inverse.hpp"
#include "solver/joint_move.hpp"

namespace iksel {

Surroundings look_around(const ChainModel& model, const JointVector& q, double nearest) {
  /// Farthest that the second-order guess is of use [rad or m].
  constexpr double kFarthest = 1.5;
  constexpr double kStep = 1e-3;
  constexpr int kMost = 6;
  Surroundings result;
  if (model.dof > kMost) return result;

  Pose pose;
  Jacobian J;
  model.fk_jacobian(q.data(), pose, J);
  // Joints that are not there are of no consequence: they have zeros, and ones on the diagonal.
  using Motions = Eigen::Matrix<double, 6, kMost>;
  Motions motions = Motions::Zero();
  motions.leftCols(model.dof) = J;
  if (model.dof == kMost) result.orientation = motions.determinant() < 0 ? -1 : 1;
  Matrix6 A = motions.transpose() * motions;
  A.diagonal().array() += 1e-12 * A.trace();
  for (int j = model.dof; j < kMost; ++j) A(j, j) = 1;
  const Eigen::LLT<Matrix6> llt(A);
  // Inverse iteration; the start is of no symmetry that an arm may have.
  Vector6 v = Vector6::Zero();
  for (int j = 0; j < model.dof; ++j) v[j] = 1 + 0.13 * j;
  for (int i = 0; i < 3; ++i) v = llt.solve(v).normalized();
  const Vector6 motion = motions * v;
  const double sigma = motion.norm();
  if (!(sigma > 0)) return result;
  const JointVector ahead = q + kStep * v.head(model.dof);
  model.fk_jacobian(ahead.data(), pose, J);
  const double kappa = motion.dot(J * v.head(model.dof) - motion) / (sigma * kStep);
  const double t = -2 * sigma / kappa;
  result.paired = std::abs(t) <= kFarthest && std::abs(t) * v.cwiseAbs().maxCoeff() >= nearest;
  if (result.paired) result.other = q + t * v.head(model.dof);
  return result;
}

bool orientations_cancel(const ChainModel& model) {
  if (model.dof != 6) return false;
  for (int j = 0; j < model.dof; ++j) {
    if (!has_whole_turns(model, j)) return false;
  }
  return true;
}

}  // namespace iksel
