// SPDX-License-Identifier: BSD-3-Clause
// The least moves to the arcs of a self-motion that no joint is swept of.
#pragma once

#include <vector>

#include "goal/joint_move.hpp"
#include "seeds/curve.hpp"

namespace iksel {

/// By how much the move to a curve may differ from that to straight lines between its points, which
/// are up to 0.05 apart.
inline double off_lines(const JointMove& move) { return 0.01 * move.weights().maxCoeff(); }

struct NearPlace {
  double move;
  JointVector q;
};

/// Where along the arcs the move from `near` may be least, by straight lines between their points,
/// each place at its nearest image inside the limits; the nearest first.
std::vector<NearPlace> find_nearest_on_arcs(const std::vector<Curve::Arc>& arcs,
                                            const JointSpace& joints, const JointVector& near,
                                            const JointMove& move);

}  // namespace iksel
