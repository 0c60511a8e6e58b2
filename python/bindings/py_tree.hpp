// SPDX-License-Identifier: BSD-3-Clause
// The answers for several tips as Python sees them.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/typing.h>

#include <vector>

#include "iksel/tree_solver.hpp"

namespace iksel::python {

namespace py = pybind11;

using OptionalTip = py::typing::Optional<py::int_>;

/// Index of a tip; -1: none.
inline OptionalTip tip_or_none(int tip) {
  const py::object value = tip < 0 ? py::object(py::none()) : py::object(py::int_(tip));
  return py::reinterpret_borrow<OptionalTip>(value);
}

struct PyTreeBatch {
  std::vector<TreeResult> rows;
  int dof = 0;
  int tips = 0;
};

}  // namespace iksel::python
