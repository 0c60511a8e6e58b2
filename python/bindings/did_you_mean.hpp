// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace iksel::python {

/// "; did you mean 'seed'?", or nothing if none of the names is close, or has that word.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

}  // namespace iksel::python
