// SPDX-License-Identifier: BSD-3-Clause
// Answers that leave some joints of a long chain where they are preferred: seven others are then an
// arm by itself, whose nearest answer is known over its whole self-motion.
#pragma once

#include "goal/joint_move.hpp"
#include "seeds/nearest_on_curve.hpp"
#include "structure/inner_chain.hpp"

namespace iksel {

class InnerArm {
 public:
  /// `inner` is of `whole`; both have to outlive this.
  InnerArm(const ChainModel& whole, const InnerChain& inner, const lanes::LaneKernels& kernels);

  /// Whether all that is preferred can stay, so that what find() gives is as good as can be.
  [[nodiscard]] bool can_hold(const NearestTo& to) const;
  /// Looks for an answer to T_base_tcp that leaves all that is preferred where it is; the nearest.
  bool find(const Pose& T_base_tcp, const NearestTo& to);
  /// All joints of the chain [rad or m].
  [[nodiscard]] const JointVector& q() const { return q_; }

 private:
  const ChainModel& whole_;
  const InnerChain& inner_;
  int swept_;  ///< in the whole chain
  NearestOnCurve curve_;
  JointVector q_;
};

}  // namespace iksel
