// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/beyond_limits.hpp"

#include <Eigen/LU>

#include "iksel/pose.hpp"
#include "seeds/fold_partner.hpp"

namespace iksel {

bool is_beyond_limits(const ChainModel& model, const Pose& T_base_tcp, JointVector q,
                      double position_tolerance, double rotation_tolerance, bool and_partner) {
  /// Farthest that joints may move for the first order to tell [rad or m].
  constexpr double kFarthest = 0.01;
  /// The tolerances count so many times, for what the first order does not tell.
  constexpr double kMargin = 2;
  /// Newton's method is there [rad or m].
  constexpr double kThere = 1e-9;
  constexpr int kSteps = 3;
  if (model.dof != 6) return false;
  Pose pose;
  Jacobian J;
  Eigen::Matrix<double, 6, 6> inverse;
  Vector6 step;
  for (int i = 0; i < kSteps; ++i) {
    model.fk_jacobian(q.data(), pose, J);
    inverse = Eigen::Matrix<double, 6, 6>(J).partialPivLu().inverse();
    step = inverse * pose_error(T_base_tcp, pose);
    // Written so that NaN tells nothing.
    if (!(step.cwiseAbs().maxCoeff() < kFarthest)) return false;
    q += step;
    if (step.cwiseAbs().maxCoeff() < kThere) break;
  }
  const Vector6 moved = kMargin * (position_tolerance * inverse.leftCols<3>().rowwise().norm() +
                                   rotation_tolerance * inverse.rightCols<3>().rowwise().norm()) +
                        step.cwiseAbs();
  if (!(moved.maxCoeff() < kFarthest)) return false;
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

}  // namespace iksel
