// SPDX-License-Identifier: BSD-3-Clause
// An arm of seven joints with one of them locked at one of its limits: where the arcs of a
// self-motion end.
#pragma once

#include <memory>
#include <vector>

#include "kinematics/chain_model.hpp"
#include "structure/closed_form.hpp"
#include "structure/elbow.hpp"

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
  /// Whether there is one of each limit at which arcs of solutions may end.
  bool are_all = false;
  /// Whether the elbow goes round, no sum is limited, and each joint with limits can be locked and
  /// is solved exactly in closed form: whether there are solutions is then known, by these and the
  /// crossing.
  bool are_closed = false;
  /// Closed curves of solutions, which have no ends, meet the plane of the elbow, and there the
  /// first joint is known. As the elbow goes round, shoulder and wrist turn about a line by a whole
  /// turn, which no way of their joints undoes: one of the two outer joints of each winds, or ends
  /// at a limit. So there are such curves only where one of each has no limits.
  struct Crossing {
    Elbow elbow;
    LockedArm first;  ///< with the first joint locked anywhere
  };
  std::optional<Crossing> crossing;

  /// Those of a chain of seven joints; none of other chains.
  static LockedArms of(const ChainModel& whole);
};

}  // namespace iksel
