// SPDX-License-Identifier: BSD-3-Clause
#include "simd/lane_chain.hpp"

#include "base/constants.hpp"

namespace iksel {

bool is_simple(const ChainModel& model) {
  if (model.kernel.joints.size() != static_cast<std::size_t>(model.dof)) return false;
  for (int j = 0; j < model.dof; ++j) {
    const KernelJoint& joint = model.kernel.joints[static_cast<std::size_t>(j)];
    if (joint.variable != j || joint.multiplier != 1.0) return false;
  }
  return true;
}

lanes::LaneChain make_lane_chain(const ChainModel& model) {
  lanes::LaneChain chain{};
  chain.n = model.dof;
  for (int j = 0; j < model.dof; ++j) {
    const KernelJoint& from = model.kernel.joints[static_cast<std::size_t>(j)];
    lanes::LaneJoint& to = chain.joint[j];
    for (int i = 0; i < 3; ++i) to.p[i] = from.p[i];
    to.cos_alpha = from.cos_alpha;
    to.sin_alpha = from.sin_alpha;
    to.cos_turn = from.cos_turn;
    to.sin_turn = from.sin_turn;
    to.offset = from.offset;
    to.prismatic = from.prismatic;
    const bool continuous = model.joints.type(j) == JointType::continuous;
    // A principal angle just off its interval is still the same angle.
    to.lower = continuous ? -kPi - 1e-9 : model.joints.lower[j];
    to.upper = continuous ? kPi + 1e-9 : model.joints.upper[j];
    to.limited = from.prismatic || (!continuous && to.upper - to.lower < 2 * kPi);
  }
  return chain;
}

}  // namespace iksel
