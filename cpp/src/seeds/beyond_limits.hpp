// SPDX-License-Identifier: BSD-3-Clause
// Whether a solution lies outside the limits, told from the arm itself.
#pragma once

#include "kinematics/chain_model.hpp"

namespace iksel {

/// Whether the solution next to q, of six joints, certainly lies outside the joints' own limits,
/// and with it whatever the tolerances [m, rad] allow around it. False where the arm is so close to
/// a singularity that it cannot be told. With `and_partner`, whether the solution with which it
/// meets where the arm is singular (fold_partner.hpp) does so too, if there is one.
bool is_beyond_limits(const ChainModel& model, const Pose& T_base_tcp, JointVector q,
                      double position_tolerance, double rotation_tolerance,
                      bool and_partner = false);

/// Whether the solution q, of six joints or seven, and all that the tolerances [m, rad] allow
/// beside it lie outside the limits, as far as the first order tells. Less sure than
/// is_beyond_limits(), and no proof: whether it is worth while to look closer.
bool seems_beyond_limits(const ChainModel& model, const Pose& T_base_tcp, const JointVector& q,
                         double position_tolerance, double rotation_tolerance);

}  // namespace iksel
