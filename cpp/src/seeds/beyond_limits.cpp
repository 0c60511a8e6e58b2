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
/// Farther than this, there is no solution beside a configuration [rad or m].
constexpr double kNotBeside = 0.3;

/// Along which a redundant arm of seven joints moves, of length 1 or 0.
JointVector self_motion_direction(const JacobianMatrix& J, const PseudoInverse& inverse) {
  const auto dof = static_cast<int>(J.cols());
  JointVector best = JointVector::Zero(dof);
  for (int k = 0; k < dof; ++k) {
    const JointVector n = JointVector::Unit(dof, k) - inverse * J.col(k);
    if (n.squaredNorm() > best.squaredNorm()) best = n;
  }
  return best.normalized();
}

/// Whether all that the tolerances allow beside q, of six joints or seven, lies outside the limits,
/// or there is nothing beside it, as far as the first order tells. No proof: whether it is worth
/// while to look closer.
bool seems_beyond_limits(const ChainModel& model, const Goal& goal, const JointVector& q) {
  constexpr double kMargin = 1.05;
  if (model.dof != 6 && model.dof != 7) return false;
  Pose pose;
  Jacobian columns;
  model.fk_jacobian(q.data(), pose, columns);
  const JacobianMatrix J = columns;
  if (is_almost_singular(J)) return false;
  const PseudoInverse inverse = damped_inverse(J, 0);
  const JointVector step = inverse * pose_error(goal.target(), pose);
  if (step.cwiseAbs().maxCoeff() > kNotBeside) return true;
  // A displacement within the tolerances adds no more than this to a weighted sum of joints, whose
  // row of the inverse this is.
  const auto reach = [&](const Eigen::Matrix<double, 1, 6>& row) {
    return kMargin * (goal.task().position_tolerance() * row.head<3>().norm() +
                      goal.task().rotation_tolerance() * row.tail<3>().norm());
  };
  // How far each is outside, less than 0 inside, and outwards of which limit.
  JointVector beyond(model.dof);
  JointVector outwards(model.dof);
  for (int j = 0; j < model.dof; ++j) {
    // Written so that NaN tells nothing.
    if (!(std::abs(step[j]) < kFarthestStep && reach(inverse.row(j)) < kFarthestStep)) return false;
    const double at = q[j] + step[j];
    const double above = at - model.joints.upper[j];
    const double below = model.joints.lower[j] - at;
    outwards[j] = above > below ? 1 : -1;
    beyond[j] = model.joints.is_periodic(j) ? -kInfinity : std::max(above, below);
  }
  if (model.dof == 6) {
    for (int j = 0; j < 6; ++j) {
      if (beyond[j] > reach(inverse.row(j))) return true;
    }
    return false;
  }
  const JointVector along = self_motion_direction(J, inverse).cwiseProduct(outwards);
  // A joint that a self-motion leaves as it is, or nearly, as where it turns back before a limit.
  for (int j = 0; j < model.dof; ++j) {
    if (beyond[j] > reach(inverse.row(j)) + std::abs(along[j]) * kFarthestStep) return true;
  }
  // Of two joints that it moves outwards and inwards, the weighted sum that it leaves as it is.
  for (int a = 0; a < model.dof; ++a) {
    for (int b = 0; b < a; ++b) {
      if (!(along[a] * along[b] < 0 && std::min(beyond[a], beyond[b]) > -kFarthestStep)) continue;
      const double weight_a = std::abs(along[b]);
      const double weight_b = std::abs(along[a]);
      const double sum = weight_a * beyond[a] + weight_b * beyond[b];
      if (sum > reach(weight_a * outwards[a] * inverse.row(a) +
                      weight_b * outwards[b] * inverse.row(b))) {
        return true;
      }
    }
  }
  return false;
}

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
  if (goal.is_full_pose() && seems_beyond_limits(model, goal, q)) return false;
  return descend_into_tolerances(model, goal, q);
}

}  // namespace iksel
