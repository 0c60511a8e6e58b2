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

/// Joints i and j turn about one axis, by `side` 1 the same way round: brings both inside their
/// limits by what the one turns for the other, and by whole turns, if that can be.
void share_turn(const JointSpace& joints, int i, int j, double side, JointVector& q) {
  const JointVector from = q;
  double nearest = kInfinity;
  for (const double of_i : {0.0, -kTwoPi, kTwoPi}) {
    for (const double of_j : {0.0, -kTwoPi, kTwoPi}) {
      const double at_i = from[i] + of_i;
      const double at_j = from[j] + of_j;
      const double one = side * (at_j - joints.lower[j]);
      const double other = side * (at_j - joints.upper[j]);
      const double least = std::max(joints.lower[i] - at_i, std::min(one, other));
      const double most = std::min(joints.upper[i] - at_i, std::max(one, other));
      const double turn = 0.5 * (least + most);
      if (!(least <= most) || !(std::abs(turn) < nearest)) continue;
      nearest = std::abs(turn);
      q[i] = at_i + turn;
      q[j] = at_j - side * turn;
    }
  }
}

/// Where axes are in line, joints share as they like what they turn about them: brings those that
/// are beyond limits inside.
void share_turns(const ChainModel& model, JointVector& q) {
  /// Twists that differ by less are of one axis [m, rad].
  constexpr double kInLine = 1e-3;
  const JointVector violations = model.joints.violations(q);
  if (!(violations.maxCoeff() > kFirstOrder)) return;
  Jacobian J;
  model.fk_jacobian(q.data(), J);
  for (int i = 0; i < model.dof; ++i) {
    for (int j = i + 1; j < model.dof; ++j) {
      if (!(std::max(violations[i], violations[j]) > kFirstOrder)) continue;
      if (model.joints.is_slide(i) || model.joints.is_slide(j)) continue;
      const double side = J.col(i).tail<3>().dot(J.col(j).tail<3>()) > 0 ? 1 : -1;
      if ((J.col(i) - side * J.col(j)).norm() > kInLine) continue;
      share_turn(model.joints, i, j, side, q);
    }
  }
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
  Jacobian J;
  Matrix6 inverse;
  Vector6 step;
  for (int i = 0; i < kSteps; ++i) {
    const Pose pose = to_pose(model.fk_jacobian(q.data(), J));
    inverse = inverse_of(J);
    step = inverse * pose_error(T_base_tcp, pose);
    // Written so that NaN tells nothing.
    if (!(step.cwiseAbs().maxCoeff() < kFirstOrder)) return false;
    q += step;
    if (step.cwiseAbs().maxCoeff() < kSmall) break;
  }
  const double off = step.squaredNorm();
  const Vector6 moved =
      (kMargin * position_tolerance + off) * inverse.leftCols<3>().rowwise().norm() +
      (kMargin * rotation_tolerance + off) * inverse.rightCols<3>().rowwise().norm();
  // Farther, the second order is more than the tolerances.
  const double farthest = std::sqrt(2 * std::min(position_tolerance, rotation_tolerance));
  if (!(moved.maxCoeff() < std::min(kFirstOrder, farthest))) return false;
  const JointVector violations = model.joints.violations(q);
  bool is_beyond = false;
  for (int j = 0; j < model.dof; ++j) {
    is_beyond = is_beyond || (!model.joints.is_periodic(j) && violations[j] > moved[j]);
  }
  if (!is_beyond || !and_partner) return is_beyond;
  const FoldPartner partner = find_fold_partner(model, J, q, 0);
  return !partner.paired ||
         is_beyond_limits(model, T_base_tcp, partner.other, position_tolerance, rotation_tolerance);
}

bool move_inside_limits(const Goal& goal, JointVector& q) {
  const bool is_hopeless =
      goal.is_full_pose() &&
      is_beyond_limits(goal.model(), goal.target(), q, goal.task().position_tolerance(),
                       goal.task().rotation_tolerance());
  if (is_hopeless) return false;
  share_turns(goal.model(), q);
  return descend_into_tolerances(goal, q);
}

}  // namespace iksel
