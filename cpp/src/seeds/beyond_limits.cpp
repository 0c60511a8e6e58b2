// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/beyond_limits.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/pseudo_inverse.hpp"
#include "iksel/pose.hpp"
#include "refine/best_effort.hpp"
#include "seeds/fold_partner.hpp"

namespace iksel {
namespace {

/// Farthest that joints may move for the first order to tell [rad or m].
constexpr double kFarthestStep = 0.01;

}  // namespace

bool is_beyond_limits(const ChainModel& model, const Pose& T_base_tcp, JointVector q,
                      double position_tolerance, double rotation_tolerance, bool and_partner) {
  /// The tolerances count so many times, for what the first order does not tell.
  constexpr double kMargin = 2;
  /// After so small a step of Newton's method the next would be next to nothing [rad or m].
  constexpr double kSmall = 3e-4;
  constexpr int kSteps = 3;
  if (model.dof != 6) return false;
  Pose pose;
  Jacobian J;
  Matrix6 inverse;
  Vector6 step;
  for (int i = 0; i < kSteps; ++i) {
    model.fk_jacobian(q.data(), pose, J);
    inverse = inverse_of(J);
    step = inverse * pose_error(T_base_tcp, pose);
    // Written so that NaN tells nothing.
    if (!(step.cwiseAbs().maxCoeff() < kFarthestStep)) return false;
    q += step;
    if (step.cwiseAbs().maxCoeff() < kSmall) break;
  }
  const double off = step.squaredNorm();
  const Vector6 moved =
      (kMargin * position_tolerance + off) * inverse.leftCols<3>().rowwise().norm() +
      (kMargin * rotation_tolerance + off) * inverse.rightCols<3>().rowwise().norm();
  // Farther, the second order is more than the tolerances.
  const double farthest = std::sqrt(2 * std::min(position_tolerance, rotation_tolerance));
  if (!(moved.maxCoeff() < std::min(kFarthestStep, farthest))) return false;
  const JointVector violations = model.joints.violations(q);
  bool is_beyond = false;
  for (int j = 0; j < model.dof; ++j) {
    is_beyond = is_beyond || (!model.joints.is_periodic(j) && violations[j] > moved[j]);
  }
  if (!is_beyond || !and_partner) return is_beyond;
  const FoldPartner partner = find_fold_partner(J, q, 0);
  return !partner.paired ||
         is_beyond_limits(model, T_base_tcp, partner.other, position_tolerance, rotation_tolerance);
}

bool move_inside_limits(const ChainModel& model, const Goal& goal, JointVector& q) {
  const bool is_hopeless =
      goal.is_full_pose() &&
      is_beyond_limits(model, goal.target(), q, goal.task().position_tolerance(),
                       goal.task().rotation_tolerance());
  if (is_hopeless) return false;
  return descend_into_tolerances(model, goal, q);
}

}  // namespace iksel
