// SPDX-License-Identifier: BSD-3-Clause
#include "tree/stacked_refiner.hpp"

#include "refine/descent.hpp"

namespace iksel {

template int descend_to_near(const StackedGoal&, const JointMove&, const JointVector&,
                             JointVector&);

int StackedRefiner::advance(unsigned /*busy*/) {
  int steps = 0;
  has_arrived_ = converge(goal_, max_iterations_, /*aim=*/1, /*wraps=*/true, q_, steps);
  return steps;
}

}  // namespace iksel
