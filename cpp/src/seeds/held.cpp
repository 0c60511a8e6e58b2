// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/held.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/constants.hpp"
#include "simd/lane_chain.hpp"

namespace iksel {

std::vector<Held::Arm> Held::arms_of(const ChainModel& whole) {
  std::vector<Arm> found;
  if (whole.dof <= kCurveJoints || !is_simple(whole)) return found;
  for (int first = 0; first + kCurveJoints <= whole.dof; ++first) {
    Arm arm;
    arm.first = first;
    RobotOptions options = whole.options;
    auto& limits = options.coupled_limits;
    for (int j = 0; j < whole.dof; ++j) {
      if (arm.contains(j)) continue;
      const std::string& name = whole.joints.name(j);
      options.locked_joints[name] = 0;
      // What is coupled with a joint at 0 says nothing of it anywhere else.
      limits.erase(std::remove_if(limits.begin(), limits.end(),
                                  [&](const CoupledLimit& limit) {
                                    return limit.coefficients.count(name) > 0;
                                  }),
                   limits.end());
    }
    arm.model = std::make_shared<const ChainModel>(whole.urdf, options);
    const auto form = find_closed_form(*arm.model);
    if (!form || !form->form.is_held) continue;
    arm.form = *form;
    found.push_back(std::move(arm));
  }
  return found;
}

Held::Held(const ChainModel& whole, const Arm& arm, const lanes::LaneKernels& kernels)
    : whole_(whole),
      arm_(arm),
      swept_(arm.first + arm.form.held),
      curve_(*arm.model, arm.form, /*is_nominal=*/true, kernels) {}

bool Held::can_hold(const NearestTo& to) const {
  bool any = false;
  for (int j = 0; j < whole_.dof; ++j) {
    if (!to.prefers(j)) continue;
    any = true;
    if (arm_.contains(j) && j != swept_) return false;
  }
  return any;
}

bool Held::find(const Pose& T_base_tcp, const NearestTo& to) {
  q_ = to.from;
  for (int j = 0; j < whole_.dof; ++j) {
    if (arm_.contains(j) || whole_.joints.is_periodic(j)) continue;
    if (!(q_[j] >= whole_.joints.lower[j] && q_[j] <= whole_.joints.upper[j])) return false;
  }
  auto behind = q_.segment(arm_.first, kCurveJoints);
  // Of the usual size, however little these joints count beside the others.
  JointVector weights = to.move.weights().segment(arm_.first, kCurveJoints);
  if (weights.maxCoeff() > 0) weights /= weights.maxCoeff();
  curve_.find(target_behind(T_base_tcp), behind, JointMove(std::move(weights)), kInfinity,
              /*takes_doubtful=*/false);
  if (curve_.size() == 0) return false;
  behind = Eigen::Map<const Eigen::VectorXd>(curve_.q(0), kCurveJoints);
  // Where it is preferred itself, the swept joint may have had to move.
  return !to.prefers(swept_) ||
         std::abs(whole_.joints.difference(swept_, to.from[swept_], q_[swept_])) <= kRounding;
}

Pose Held::target_behind(const Pose& T_base_tcp) const {
  // T(before, arm, behind) = A(before) S(arm) C(behind), and of these S is wanted as it is between
  // A(0) and C(0).
  JointVector before = JointVector::Zero(whole_.dof);
  const JointVector zero = before;
  JointVector behind = before;
  const int end = arm_.first + kCurveJoints;
  before.head(arm_.first) = q_.head(arm_.first);
  behind.tail(whole_.dof - end) = q_.tail(whole_.dof - end);
  const Pose at_zero = whole_.fk(zero.data());
  const Pose T = at_zero * whole_.fk(before.data()).inverse() * T_base_tcp *
                 whole_.fk(behind.data()).inverse() * at_zero;
  return to_pose(arm_.model->kernel.base).inverse() * T * to_pose(arm_.model->kernel.tip).inverse();
}

}  // namespace iksel
