// SPDX-License-Identifier: BSD-3-Clause
// Coupled limits as arguments.
#pragma once

#include <string>
#include <vector>

#include "array_checks.hpp"
#include "iksel/coupled_limit.hpp"

namespace iksel::python {

/// A sequence of CoupledLimit. Throws InvalidArgumentError that names the culprit.
std::vector<CoupledLimit> as_coupled_limits(const py::handle& value, const std::string& name);

}  // namespace iksel::python
