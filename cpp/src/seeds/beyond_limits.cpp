// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/beyond_limits.hpp"

#include "base/pseudo_inverse.hpp"
#include "iksel/pose.hpp"

namespace iksel {

bool is_beyond_limits(const ChainModel& model, const Pose& T_base_tcp, JointVector q,
                      double position_tolerance, double rotation_tolerance) {
  /// Farthest that joints may move for the first order to tell [rad or m].
  constexpr double kFarthest = 0.01;
  /// The tolerances count so many times, for what the first order does not tell.
  constexpr double kMargin = 2;
  constexpr int kSteps = 3;
  if (model.dof != 6) return false;
  Pose pose;
  Jacobian J;
  PseudoInverse inverse;
  JointVector step;
  for (int i = 0; i < kSteps; ++i) {
    model.fk_jacobian(q.data(), pose, J);
    inverse = damped_inverse(J, 0);
    step = inverse * pose_error(T_base_tcp, pose);
    // Written so that NaN tells nothing.
    if (!(step.cwiseAbs().maxCoeff() < kFarthest)) return false;
    q += step;
  }
  const JointVector moved =
      kMargin * (position_tolerance * inverse.leftCols<3>().rowwise().norm() +
                 rotation_tolerance * inverse.rightCols<3>().rowwise().norm()) +
      step.cwiseAbs();
  if (!(moved.maxCoeff() < kFarthest)) return false;
  const JointVector violations = model.joints.violations(q);
  for (int j = 0; j < model.dof; ++j) {
    if (!model.joints.is_periodic(j) && violations[j] > moved[j]) return true;
  }
  return false;
}

}  // namespace iksel
