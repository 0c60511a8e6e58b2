// SPDX-License-Identifier: BSD-3-Clause
// Seven consecutive joints of a longer chain of which one can be swept: an arm by itself, while
// what carries it, or carries its work, stays.
#pragma once

#include <memory>
#include <vector>

#include "base/constants.hpp"
#include "kinematics/chain_model.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

struct InnerChain {
  /// With the other joints locked at 0.
  std::shared_ptr<const ChainModel> model;
  ClosedFormChain form;
  /// The first of its joints in the longer chain.
  int first = 0;

  /// All that a chain has; none of chains of seven joints or fewer, or where joints mimic others.
  static std::vector<InnerChain> of(const ChainModel& whole);

  [[nodiscard]] bool contains(int joint) const {
    return joint >= first && joint < first + kCurveJoints;
  }
  /// Y (reduction.hpp) of the target for these joints while the others are at their values in q.
  [[nodiscard]] Pose target(const ChainModel& whole, const Pose& T_base_tcp,
                            const JointVector& q) const;
};

}  // namespace iksel
