// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/inner_arm.hpp"

#include <cmath>
#include <utility>

namespace iksel {

InnerArm::InnerArm(const ChainModel& whole, const InnerChain& inner,
                   const lanes::LaneKernels& kernels)
    : whole_(whole),
      inner_(inner),
      swept_(inner.first + inner.form.held),
      curve_(*inner.model, inner.form, /*is_nominal=*/true, kernels) {}

bool InnerArm::can_hold(const NearestTo& to) const {
  bool any = false;
  for (int j = 0; j < whole_.dof; ++j) {
    if (!to.prefers(j)) continue;
    any = true;
    if (inner_.contains(j) && j != swept_) return false;
  }
  return any;
}

bool InnerArm::find(const Pose& T_base_tcp, const NearestTo& to) {
  q_ = to.from;
  for (int j = 0; j < whole_.dof; ++j) {
    if (inner_.contains(j) || whole_.joints.is_periodic(j)) continue;
    if (!(q_[j] >= whole_.joints.lower[j] && q_[j] <= whole_.joints.upper[j])) return false;
  }
  const Pose Y = inner_.target(whole_, T_base_tcp, q_);
  const JointVector near = q_.segment(inner_.first, kCurveJoints);
  // Of the usual size, however little these joints count beside the others.
  JointVector weights = to.move.weights().segment(inner_.first, kCurveJoints);
  if (weights.maxCoeff() > 0) weights /= weights.maxCoeff();
  curve_.find(Y, near, JointMove(std::move(weights)), kInfinity);
  if (curve_.size() == 0) return false;
  for (int j = 0; j < kCurveJoints; ++j) q_[inner_.first + j] = curve_.q(0)[j];
  // Where it is preferred itself, the swept joint may have had to move.
  constexpr double kStays = 1e-9;
  return !to.prefers(swept_) ||
         std::abs(whole_.joints.difference(swept_, to.from[swept_], q_[swept_])) <= kStays;
}

}  // namespace iksel
