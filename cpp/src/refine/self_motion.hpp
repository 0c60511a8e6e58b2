// SPDX-License-Identifier: BSD-3-Clause
// A redundant arm moves its joints while the TCP stays where it is. Moving along this self-motion
// makes a cost of the joint values small.
#pragma once

#include "base/function_ref.hpp"
#include "goal/goal.hpp"
#include "goal/joint_move.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

/// Value of a cost at q; also its gradient, and the diagonal of a positive approximation of its
/// second derivative, if they are not null.
using JointCost =
    FunctionRef<double(const JointVector& q, JointVector* gradient, JointVector* curvature)>;

/// Moves q, a solution inside the limits, over what the goal allows until the cost is at a local
/// minimum or after `most` steps. q is a solution inside the limits and costs no more than before
/// when it ends. Returns the steps taken.
int descend_self_motion(const ChainModel& model, const Goal& goal, const JointCost& cost, int most,
                        JointVector& q);

/// The same for the move from `near`.
int descend_to_near(const ChainModel& model, const Goal& goal, const JointMove& move,
                    const JointVector& near, JointVector& q);

/// Steps from a configuration to the next pose of a path at most.
inline constexpr int kStepsToNext = 20;

/// Brings q to the goal by Levenberg-Marquardt with the limits inside the step, to a hundredth of
/// the tolerances, in at most `most` steps; `steps` counts those taken. False if it does not get
/// within the tolerances and the limits.
bool converge(const ChainModel& model, const Goal& goal, int most, JointVector& q, int& steps);
inline bool converge(const ChainModel& model, const Goal& goal, int most, JointVector& q) {
  int steps = 0;
  return converge(model, goal, most, q, steps);
}

}  // namespace iksel
