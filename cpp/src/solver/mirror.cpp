// SPDX-License-Identifier: BSD-3-Clause
#include "solver/mirror.hpp"

#include <cmath>

#include "math/pseudo_inverse.hpp"
#include "math/symmetric.hpp"
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
  Matrix6 motions = Matrix6::Zero();
  motions.leftCols(model.dof) = J;
  if (model.dof == kMost) result.orientation = motions.determinant() < 0 ? -1 : 1;
  double A[kMost][kMost];
  double trace = 0;
  for (int i = 0; i < kMost; ++i) {
    for (int k = 0; k <= i; ++k) A[i][k] = motions.col(i).dot(motions.col(k));
    trace += A[i][i];
  }
  for (int j = model.dof; j < kMost; ++j) A[j][j] = 1;
  const SymmetricFactors<double> factors(A, 1e-12 * trace);
  // Inverse iteration, which goes to the direction of the least singular value; the start is of no
  // symmetry that an arm may have.
  double start[kMost] = {};
  for (int j = 0; j < model.dof; ++j) start[j] = 1 + 0.13 * j;
  double next[kMost];
  factors.solve(start, next);
  factors.solve(next, start);
  factors.solve(start, next);
  const Vector6 v = Eigen::Map<const Vector6>(next).normalized();
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
