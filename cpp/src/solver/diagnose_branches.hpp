// SPDX-License-Identifier: BSD-3-Clause
// Why not, where all branches of a pose are known in closed form: without any search.
#pragma once

#include <optional>
#include <vector>

#include "goal/goal.hpp"
#include "iksel/diagnosis.hpp"
#include "seeds/enumeration.hpp"

namespace iksel {

struct BranchReasons {
  /// All but the best effort.
  Diagnosis diagnosis;
  /// From where to descend to that.
  std::vector<JointVector> seeds;
};

/// Why none of the branches of a goal that is proven to have no answer is one: the branch that
/// violates the limits least, or the angle that there is not. Nothing if rounding leaves that open.
/// `branches`: of the goal's task. Y as in reduction.hpp.
std::optional<BranchReasons> explain_branches(const Goal& goal, const Pose& Y,
                                              Enumeration& branches);

}  // namespace iksel
