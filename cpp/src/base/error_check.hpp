// SPDX-License-Identifier: BSD-3-Clause
// Checks of arguments, and the words of their errors.
#pragma once

#include <cstddef>

#include "iksel/types.hpp"

namespace iksel {

/// Throws InvalidArgumentError "name[index]: what"; without the index if that is negative.
[[noreturn]] void throw_invalid(const char* name, std::ptrdiff_t index, const std::string& what);

/// Throws InvalidArgumentError unless q has `dof` finite elements.
void check_joints(const JointVector& q, int dof, const char* name);

}  // namespace iksel
