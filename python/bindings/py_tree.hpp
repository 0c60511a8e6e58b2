// SPDX-License-Identifier: BSD-3-Clause
// The answers of a batch for several tips as Python sees them.
#pragma once

#include <vector>

#include "iksel/tree_solver.hpp"

namespace iksel::python {

struct PyTreeBatch {
  std::vector<TreeResult> rows;
  int dof = 0;
  int tips = 0;
};

}  // namespace iksel::python
