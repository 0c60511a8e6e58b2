// SPDX-License-Identifier: BSD-3-Clause
// Python callables as iksel::Progress.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/typing.h>

#include <cstddef>
#include <optional>

#include "iksel/database.hpp"

namespace iksel::python {

namespace py = pybind11;

using ProgressCallable = py::typing::Callable<py::object(int, int)>;

/// Calls `callable(done, total)` if there is one, and lets Ctrl-C end the work in any case. To be
/// called without the GIL; an exception passes through the work to the caller. The callable must
/// outlive the returned function.
inline Progress make_progress(const std::optional<ProgressCallable>& callable) {
  return [&callable](std::size_t done, std::size_t total) {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (callable) (*callable)(done, total);
  };
}

}  // namespace iksel::python
