// SPDX-License-Identifier: BSD-3-Clause
// The joints of several chains move while all tips stay where they are: along this self-motion the
// move from given joint values is made small.
#pragma once

#include "goal/joint_move.hpp"
#include "tree/stacked_goal.hpp"

namespace iksel {

/// Moves q, a solution, over what the goal allows until the move from `near` is at a local minimum
/// or the steps are used up; q is a solution and no farther away than before when it ends. Returns
/// the steps.
int descend_to_near(const StackedGoal& goal, const JointMove& move, const JointVector& near,
                    JointVector& q);

}  // namespace iksel
