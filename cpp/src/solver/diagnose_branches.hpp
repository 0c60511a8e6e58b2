// SPDX-License-Identifier: BSD-3-Clause
// Why not, where all branches of a pose are known in closed form: without any search.
#pragma once

#include "goal/goal.hpp"
#include "iksel/diagnosis.hpp"
#include "refine/best_effort.hpp"
#include "seeds/enumeration.hpp"

namespace iksel {

/// Puts into `out` why none of the branches of a goal that is proven to have no answer is one: the
/// branch that violates the limits least, or the angle that there is not; and makes an effort from
/// there. False if rounding leaves that open. `branches`: of the goal's task. Y as in
/// reduction.hpp.
bool explain_branches(const Goal& goal, const Pose& Y, Enumeration& branches, BestEffort& effort,
                      Diagnosis& out);

}  // namespace iksel
