// SPDX-License-Identifier: BSD-3-Clause
// Answers that hold some joints of a long chain where they are preferred: seven consecutive others
// are then an arm by itself, whose nearest answer is known over its whole self-motion.
#pragma once

#include <memory>
#include <vector>

#include "base/constants.hpp"
#include "goal/joint_move.hpp"
#include "seeds/nearest_on_curve.hpp"

namespace iksel {

class Held {
 public:
  /// What does not change while it is asked.
  struct Arm {
    /// With the other joints locked at 0.
    std::shared_ptr<const ChainModel> model;
    ClosedFormChain form;
    /// The first of its joints in the longer chain.
    int first = 0;

    [[nodiscard]] bool contains(int joint) const {
      return joint >= first && joint < first + kCurveJoints;
    }
  };
  /// All that a chain has; none of chains of seven joints or fewer, or where joints mimic others.
  static std::vector<Arm> arms_of(const ChainModel& whole);

  /// `arm` is of `whole`; both have to outlive this.
  Held(const ChainModel& whole, const Arm& arm, const lanes::LaneKernels& kernels);

  /// Whether all that is preferred can stay, so that what find() gives is as good as can be.
  [[nodiscard]] bool can_hold(const NearestTo& to) const;
  /// Looks for an answer to T_base_tcp that leaves all that is preferred where it is; the nearest.
  bool find(const Pose& T_base_tcp, const NearestTo& to);
  /// All joints of the chain [rad or m].
  [[nodiscard]] const JointVector& q() const { return q_; }

 private:
  /// Y (reduction.hpp) of the target for the arm while the other joints are at their values in q.
  [[nodiscard]] Pose target_behind(const Pose& T_base_tcp) const;

  const ChainModel& whole_;
  const Arm& arm_;
  int swept_;  ///< in the whole chain
  NearestOnCurve curve_;
  JointVector q_;
};

}  // namespace iksel
