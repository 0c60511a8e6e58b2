// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/enumeration.hpp"

#include <algorithm>

namespace iksel {

Enumeration::Enumeration(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
                         double position_tolerance, double rotation_tolerance,
                         const lanes::LaneKernels& kernels)
    : model_(model), chain_(chain), kernels_(kernels), is_nominal_(is_nominal) {
  // Beyond the tolerances by as much as to be sure.
  chain_.form.error =
      4 * std::max({position_tolerance / chain.unit, rotation_tolerance, kStructureTolerance});
  for (int lane = 0; lane < kMost; ++lane) {
    for (int s = 0; s < 3; ++s) pack_.sign[s][lane] = (lane >> s & 1) == 0 ? 1 : -1;
  }
}

void Enumeration::find(const Pose& Y) {
  double rows[12];
  chain_.write_target(chain_.reversed ? Y.inverse() : Y, rows);
  for (int i = 0; i < 12; ++i) std::fill_n(pack_.target[i], kMost, rows[i]);
  kernels_.solve_branches(chain_.form, pack_);
  size_ = 0;
  complete_ = is_nominal_;
  certain_ = is_nominal_;
  for (int lane = 0; lane < kMost; ++lane) take(lane);
}

void Enumeration::take(int lane) {
  // An angle off by more says nothing.
  constexpr double kVague = 0.3;
  if (pack_.best[lane] < 0) return;
  const double bound = pack_.error[lane];
  // Written so that NaN is vague.
  const bool is_vague = !(bound < kVague);
  bool is_sure = !is_vague && pack_.worst[lane] >= 0;
  std::array<double, 6>& q = q_[static_cast<std::size_t>(size_)];
  for (int i = 0; i < 6; ++i) {
    const int j = chain_.joints[i];
    q[static_cast<std::size_t>(j)] =
        pack_.angle[i][lane] - model_.kernel.joints[static_cast<std::size_t>(j)].offset;
  }
  const JointSpace& joints = model_.joints;
  joints.wrap(q.data());
  for (int j = 0; j < 6; ++j) {
    double& value = q[static_cast<std::size_t>(j)];
    if (joints.type(j) == JointType::continuous) continue;
    const double inside = std::min(std::max(value, joints.lower[j]), joints.upper[j]);
    double beyond = std::abs(value - inside);
    if (beyond > 0) {
      // The other limit may be nearer, a whole turn away.
      const double image = value < inside ? value + kTwoPi : value - kTwoPi;
      const double inside2 = std::min(std::max(image, joints.lower[j]), joints.upper[j]);
      const bool is_nearer = std::abs(image - inside2) < beyond;
      beyond = std::min(beyond, std::abs(image - inside2));
      if (!is_vague && beyond > bound) return;
      is_sure = false;
      value = is_nearer ? inside2 : inside;
    }
  }
  complete_ = complete_ && !is_vague;
  certain_ = certain_ && is_sure;
  ++size_;
}

}  // namespace iksel
