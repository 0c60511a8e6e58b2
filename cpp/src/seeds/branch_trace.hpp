// SPDX-License-Identifier: BSD-3-Clause
// Why a pose has fewer branches in closed form than there could be: which angle there is not.
#pragma once

#include "simd/branch_types.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

/// Two points of a chain, and how far apart the joint between them lets them be [m].
struct ElbowSpan {
  double needed;
  double least, most;
  /// By how much what is needed lies outside.
  [[nodiscard]] double gap() const { return needed > most ? needed - most : least - needed; }
};

/// The first angle that a branch does not have.
struct MissingAngle {
  /// How many angles of the branch were found before; -1: it has all of them.
  int found = -1;
  /// The joint whose angle there is not, as the form counts.
  int joint = -1;
  /// The difference of squares that its subproblem takes the root of, below 0.
  double square = 0;
  /// Whether that joint is the elbow, which bends for the distance from axis 2 to axis 4 as the
  /// form counts them: where those are parallel, across them.
  bool is_elbow = false;
  ElbowSpan span{};
};

/// Of the branch in a lane of a pack that has its target and signs. Forms without a held joint.
MissingAngle find_missing_angle(const ClosedFormChain& chain, const lanes::BranchPack& pack,
                                int lane);

}  // namespace iksel
