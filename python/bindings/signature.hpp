// SPDX-License-Identifier: BSD-3-Clause
// Calls that do not fit are answered in a sentence, in place of pybind11's list of overloads, and
// objects that were never made are refused in place of read.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "iksel/error.hpp"

namespace iksel::python {

namespace py = pybind11;

/// A call that does not fit: an unknown keyword, a missing argument, one of another class.
class SignatureError : public InvalidArgumentError {
 public:
  using InvalidArgumentError::InvalidArgumentError;
};

/// "; did you mean 'seed'?", or nothing if none of the names is close, or has that word.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

/// To come last: guards all that the module has by then, functions and classes.
void guard_module(py::module_& m);

}  // namespace iksel::python
