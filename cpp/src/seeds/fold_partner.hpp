// SPDX-License-Identifier: BSD-3-Clause
// From a solution to its partner: solutions come in pairs that meet where the arm is singular.
#pragma once

#include "kinematics/chain_model.hpp"

namespace iksel {

/// Around a solution of a chain with at most 6 joints.
struct FoldPartner {
  /// Whether the other solution of a pair that meets at a near singularity can be seen, and about
  /// where it is. Along the joint direction v of the least singular value, u its direction of
  /// motion, the TCP moves by u (sigma t + kappa t^2 / 2): it is back at t = -2 sigma / kappa.
  bool paired = false;
  JointVector other;
};

/// `J` is the Jacobian of the chain at the solution q. `nearest`: a pair nearer than this in every
/// joint counts as one solution [rad or m].
FoldPartner find_fold_partner(const ChainModel& model, Jacobian J, const JointVector& q,
                              double nearest);

}  // namespace iksel
