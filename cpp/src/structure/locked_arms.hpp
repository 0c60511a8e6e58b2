// SPDX-License-Identifier: BSD-3-Clause
// An arm of seven joints with one of them locked at one of its limits: where the arcs of a
// self-motion end.
#pragma once

#include <memory>
#include <vector>

#include "kinematics/chain_model.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

struct LockedArm {
  /// Of the six other joints.
  std::shared_ptr<const ChainModel> model;
  /// A closed form, or a residual, of whole poses.
  std::optional<ClosedFormChain> pose, residual;
  /// The joint of the seven that is locked, and where [rad or m].
  int joint = 0;
  double value = 0;
  bool is_upper = false;  ///< of its two limits
};

struct LockedArms {
  std::vector<LockedArm> arms;
  /// Whether these are all: each joint with limits can be solved for with that joint locked, and no
  /// limits are coupled.
  bool are_all = false;

  /// Those of a chain of seven joints; none of other chains.
  static LockedArms of(const ChainModel& whole);
};

}  // namespace iksel
