// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/fold_partner.hpp"

#include <cmath>

#include "base/constants.hpp"
#include "base/pseudo_inverse.hpp"
#include "base/symmetric.hpp"
#include "kinematics/joint_space.hpp"

namespace iksel {
namespace {

/// How the twist J v changes in unit time while the joints move at the rates v: a joint's axis and
/// origin turn with the joints before it, and the TCP moves past it with those behind. A variable
/// that moves several joints counts as one, which a prediction may.
Vector6 acceleration(const Jacobian& J, const Vector6& v, const Vector6& twist) {
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  Eigen::Vector3d behind = twist.head<3>();
  Vector6 result = Vector6::Zero();
  for (Eigen::Index j = 0; j < J.cols(); ++j) {
    const Eigen::Vector3d linear = v[j] * J.col(j).head<3>();
    const Eigen::Vector3d angular = v[j] * J.col(j).tail<3>();
    result.head<3>() += turned.cross(linear) + angular.cross(behind);
    result.tail<3>() += turned.cross(angular);
    turned += angular;
    behind -= linear;
  }
  return result;
}

}  // namespace

FoldPartner find_fold_partner(const ChainModel& model, Jacobian J, const JointVector& q,
                              double nearest) {
  /// Farthest that the second-order guess is of use [rad or units].
  constexpr double kFarthest = 1.5;
  FoldPartner result;
  const auto dof = static_cast<int>(J.cols());
  // Else what slides and what turns could not be compared, where lengths are millimetres.
  model.to_unit(J);

  // Joints that are not there are of no consequence: they have zeros, and ones on the diagonal.
  double columns[kPoseJoints][kPoseJoints] = {};
  for (int j = 0; j < dof; ++j) {
    for (int i = 0; i < kPoseJoints; ++i) columns[j][i] = J(i, j);
  }
  double A[kPoseJoints][kPoseJoints];
  double trace = 0;
  for (int j = 0; j < kPoseJoints; ++j) {
#pragma GCC unroll 6
    for (int k = 0; k <= j; ++k) {
      A[j][k] = 0;
      for (int i = 0; i < kPoseJoints; ++i) A[j][k] += columns[j][i] * columns[k][i];
    }
    trace += A[j][j];
  }
  for (int j = dof; j < kPoseJoints; ++j) A[j][j] = 1;
  const SymmetricFactors<double> factors(A, 1e-12 * trace);
  // Inverse iteration, which goes to the direction of the least singular value; the start is of no
  // symmetry that an arm may have.
  double start[kPoseJoints] = {};
  for (int j = 0; j < dof; ++j) start[j] = 1 + 0.13 * j;
  double next[kPoseJoints];
  factors.solve(start, next);
  factors.solve(next, start);
  factors.solve(start, next);
  const Vector6 v = Eigen::Map<const Vector6>(next).normalized();
  const Vector6 twist = J * v.head(dof);
  const double sigma = twist.norm();
  if (!(sigma > 0)) return result;
  const double kappa = twist.dot(acceleration(J, v, twist)) / sigma;
  const double t = -2 * sigma / kappa;
  JointVector move = t * v.head(dof);
  for (int j = 0; j < dof; ++j) move[j] *= model.joints.is_slide(j) ? model.unit : 1;
  result.paired = std::abs(t) <= kFarthest && move.cwiseAbs().maxCoeff() >= nearest;
  if (result.paired) result.other = q + move;
  return result;
}

}  // namespace iksel
