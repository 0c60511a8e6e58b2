// SPDX-License-Identifier: BSD-3-Clause
// The axes of a chain of fewer than six joints, or of a task that leaves rotations free, completed
// to six: by axes behind the last joint that are locked at zero, where joints are missing, or that
// turn as they like, where the task does not ask for a rotation.
#pragma once

#include <vector>

#include "iksel/task.hpp"
#include "structure/screw_axes.hpp"

namespace iksel {

struct CompletedAxes {
  ScrewAxes axes;
  /// Bit j: axis j turns as it likes: one behind the last joint, or a joint of which the task does
  /// not feel the angle.
  unsigned free = 0;
};

/// The ways in which the axes of a chain, whose joints all turn, can be completed for a task; none
/// if they can't. `tolerance`: as of ClosedFormChain [rad, units of the reach].
std::vector<CompletedAxes> complete_axes(const ChainModel& model, const Task& task,
                                         double tolerance);

}  // namespace iksel
