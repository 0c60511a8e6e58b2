// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/branch_lanes.hpp"

#include <algorithm>

#include "seeds/enumeration.hpp"

namespace iksel {

BranchLanes::BranchLanes(const ChainModel& model, const ClosedFormChain& chain,
                         const BranchTrials& trials, const lanes::LaneKernels& kernels)
    : joints_(model.joints), form_(model, chain, kernels), trials_(trials), pack_{} {}

void BranchLanes::begin(BranchLanes& /*refiner*/, int lane, const Goal& /*goal*/, const Pose& Y) {
  form_.chain.set_target(Y, lane, pack_);
  lanes_[lane] = Lane();
  lanes_[lane].trials = trials_.of(Y);
  lanes_[lane].turn = trials_.turn(Y);
}

bool BranchLanes::load(BranchLanes& /*refiner*/, int lane) {
  Lane& in = lanes_[lane];
  if (in.trials.next == in.trials.end) return false;
  if (is_complete() && (in.is_unsure || in.refused > 0)) return false;
  form_.set_trial(*in.trials.next++, in.turn, lane, pack_);
  return true;
}

int BranchLanes::advance(unsigned /*busy*/) {
  const lanes::LaneKernels& kernels = form_.kernels;
  (is_complete() ? kernels.solve_branches : kernels.find_branches)(form_.chain.form, pack_);
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    Lane& in = lanes_[lane];
    if (is_complete()) {
      const bool may_be = !is_ruled_out(pack_, lane);
      in.is_inside = may_be && !(pack_.beyond[lane] > 0);
      in.is_unsure = may_be && !in.is_inside;
    } else {
      in.is_inside = form_.is_inside(pack_, lane);
    }
  }
  return 0;
}

JointVector BranchLanes::q(int lane) const {
  JointVector q(joints_.dof());
  if (!is_complete()) q[form_.chain.held] = form_.held(pack_, lane);
  form_.chain.copy_joints(pack_.q, lane, q.data());
  for (int j = 0; j < joints_.dof(); ++j) {
    if (!joints_.is_periodic(j))
      q[j] = std::min(std::max(q[j], joints_.lower[j]), joints_.upper[j]);
  }
  return q;
}

Proof BranchLanes::proof(int lane) const {
  const Lane& in = lanes_[lane];
  const bool is_none = is_complete() && !in.is_unsure && in.refused == 0;
  return is_none ? Proof::closed_form : Proof::none;
}

}  // namespace iksel
