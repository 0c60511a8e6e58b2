// SPDX-License-Identifier: BSD-3-Clause
// All joints brought to a goal, and along a self-motion, where redundant arms move their joints
// while the tip stays where it is, to where a cost of the joint values is small.
#pragma once

#include "goal/goal.hpp"
#include "goal/joint_move.hpp"

namespace iksel {

/// Part of the tolerances to which joint values are brought that others start from.
inline constexpr double kWellInside = 0.01;

/// Brings q to the goal by Levenberg-Marquardt with the limits inside the step, to the part `aim`
/// of the tolerances, or to all of it in the last of `most` steps; `steps` counts those taken.
/// `wraps`: joints that turn on and on are not held at their limits, but wrapped at the end. False
/// if it does not get within the tolerances and the limits.
bool converge(const Goal& goal, int most, JointVector& q, int& steps, double aim = kWellInside,
              bool wraps = false);
inline bool converge(const Goal& goal, int most, JointVector& q) {
  int steps = 0;
  return converge(goal, most, q, steps);
}

/// Moves q, a solution inside the limits, over what the goal allows until the cost is at a local
/// minimum or after `most` steps. q is a solution inside the limits and costs no more than before
/// when it ends. Returns the steps taken.
int descend_self_motion(const Goal& goal, const JointCost& cost, int most, JointVector& q);

/// Moves q so to where the move from `near` is at a local minimum.
int descend_to_near(const Goal& goal, const JointMove& move, const JointVector& near,
                    JointVector& q);
/// And to where the joint is least late that is latest to come from `from`, where these moves are
/// the longest in time.
int descend_in_time(const Goal& goal, const JointVector& longest, const JointVector& from,
                    JointVector& q);

/// Steps from a configuration to the next pose of a path at most.
inline constexpr int kStepsToNext = 20;

}  // namespace iksel
