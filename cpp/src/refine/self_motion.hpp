// SPDX-License-Identifier: BSD-3-Clause
// A redundant arm moves its joints while the tip stays where it is. Sliding along this self-motion
// makes a cost of the joint values small.
#pragma once

#include "base/function_ref.hpp"
#include "goal/task_space.hpp"
#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

/// Value of a cost at q; also its gradient, and the diagonal of a positive approximation of its
/// second derivative, if they are not null.
using JointCost =
    FunctionRef<double(const JointVector& q, JointVector* gradient, JointVector* curvature)>;

/// Slides q, a solution inside the limits, over what the task allows until the cost is at a local
/// minimum or after `most` steps. q is a solution inside the limits and costs no more than before
/// when it ends. Returns the steps taken.
int slide(const ChainModel& model, const SolverOptions& options, const TaskSpace& task,
          const Pose& T_base_tip, const JointCost& cost, int most, JointVector& q);

/// Brings q to the task by Levenberg-Marquardt with the limits inside the step, to a hundredth of
/// the tolerances, in at most `most` steps. False if it does not get within the tolerances and the
/// limits.
bool converge(const ChainModel& model, const SolverOptions& options, const TaskSpace& task,
              const Pose& T_base_tip, int most, JointVector& q);

}  // namespace iksel
