// SPDX-License-Identifier: BSD-3-Clause
// Solutions that lie outside the limits, and what the tolerances allow beside them.
#pragma once

#include "goal/goal.hpp"

namespace iksel {

/// Farthest that joints may move for the first order to tell [rad or m].
inline constexpr double kFirstOrder = 0.01;

/// Whether the solution next to q, of six joints, certainly lies outside the joints' own limits,
/// and with it whatever the tolerances [m, rad] allow around it. False where the arm is so close to
/// a singularity that it cannot be told. With `and_partner`, whether the solution with which it
/// meets where the arm is singular (fold_partner.hpp) does so too, if there is one.
bool is_beyond_limits(const ChainModel& model, const Pose& T_base_tcp, JointVector q,
                      double position_tolerance, double rotation_tolerance,
                      bool and_partner = false);

/// From q, a solution beside limits, to an answer inside of them, if the tolerances allow one that
/// can be found from there. q becomes the answer.
bool move_inside_limits(const Goal& goal, JointVector& q);

}  // namespace iksel
