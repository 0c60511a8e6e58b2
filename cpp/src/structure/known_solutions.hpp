// SPDX-License-Identifier: BSD-3-Clause
// Whether a closed form finds solutions that are known, and which joints a self-motion moves.
#pragma once

#include "structure/closed_form.hpp"

namespace iksel {

/// Whether the branches of poses of random configurations have these among them: not where the axes
/// lie so that solutions come in families, of which the form has some, or that it divides by 0. Of
/// a chain with a joint that is held, at its own value; and that joint has to move along the
/// self-motion. For full poses.
bool finds_known_solutions(const ChainModel& model, ClosedFormChain chain);

/// Whether a joint of seven moves along the self-motion anywhere: where it does not, its value is
/// fixed by the pose, and the six others are singular wherever it is held.
bool takes_part_in_self_motion(const ChainModel& model, int joint);

/// Whether six joints move the tip in five directions at most, wherever they are: solutions are
/// then no points, and residuals have no roots but for rounding.
bool is_singular_everywhere(const ChainModel& model);

}  // namespace iksel
