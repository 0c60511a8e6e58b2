// SPDX-License-Identifier: BSD-3-Clause
// Python callables as iksel::Filter.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>

#include "array_checks.hpp"
#include "gil.hpp"
#include "iksel/request.hpp"

namespace iksel::python {

/// A filter that calls `callable` with an (n, dof) array and expects n truth values; an exception
/// passes through the solve to the caller. The callable and its name must outlive the filter.
inline Filter make_filter(py::handle callable, const char* name, int dof) {
  check_callable(callable, name);
  return [callable, name, dof](const double* q, std::size_t count, bool* keep) {
    const GilAcquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const auto n = static_cast<py::ssize_t>(count);
    py::array_t<double> candidates({n, static_cast<py::ssize_t>(dof)});
    std::copy_n(q, count * static_cast<std::size_t>(dof), candidates.mutable_data());
    const py::object answer = call_python(callable, candidates);
    const auto array = py::array::ensure(answer);
    if (!array) throw_wrong_type(name, "an array of truth values", answer);
    const char kind = array.dtype().kind();
    if (kind != 'b' || array.size() != n || array.ndim() > 1) {
      throw InvalidArgumentError(std::string(name) + ": expected to get back " + std::to_string(n) +
                                 " truth values for the (" + std::to_string(n) + ", " +
                                 std::to_string(dof) + ") candidates, got shape " +
                                 shape_text(array) + " of dtype " +
                                 py::cast<std::string>(py::str(array.dtype())));
    }
    const auto flags = py::array_t<bool>::ensure(array);
    std::copy_n(flags.data(), count, keep);
  };
}

}  // namespace iksel::python
