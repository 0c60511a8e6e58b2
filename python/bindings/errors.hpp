// SPDX-License-Identifier: BSD-3-Clause
// Exceptions of C++ as those of Python.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>

namespace iksel::python {

/// Sets Python's error to that class which stands for the exception's.
void set_error(const std::exception& error);

/// What function() returns; null, with Python's error set, if it throws.
template <class Function>
PyObject* or_error(const Function& function) {
  try {
    return function();
  } catch (pybind11::error_already_set& error) {
    error.restore();
  } catch (const pybind11::builtin_exception& error) {
    error.set_error();
  } catch (const std::exception& error) {
    set_error(error);
  }
  return nullptr;
}

}  // namespace iksel::python
