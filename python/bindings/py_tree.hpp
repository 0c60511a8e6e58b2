// SPDX-License-Identifier: BSD-3-Clause
// The answers for several tips as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <vector>

#include "iksel/tree_solver.hpp"
#include "results.hpp"

namespace iksel::python {

namespace py = pybind11;

/// Index of a tip; -1: none.
inline OptionalIndex tip_or_none(int tip) {
  return OptionalIndex(tip < 0 ? py::object(py::none()) : py::object(py::int_(tip)));
}

struct PyTreeBatch {
  std::vector<TreeResult> rows;
  int dof = 0;
  int tips = 0;
};

}  // namespace iksel::python
