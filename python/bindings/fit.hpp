// SPDX-License-Identifier: BSD-3-Clause
// Why a call fits none of a function's overloads.
#pragma once

#include <pybind11/pybind11.h>

namespace iksel::python {

/// Puts an error that says so in the place of the TypeError that pybind11 has just set; leaves
/// other errors alone. The arguments are those of a METH_FASTCALL | METH_KEYWORDS function.
void explain_misfit(PyObject* self, PyObject* const* args, Py_ssize_t count,
                    PyObject* keywords) noexcept;

}  // namespace iksel::python
