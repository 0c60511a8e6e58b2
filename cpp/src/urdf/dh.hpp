// SPDX-License-Identifier: BSD-3-Clause
// Denavit and Hartenberg's parameters as URDF.
#pragma once

#include <string>

#include "iksel/dh.hpp"

namespace iksel {

/// The URDF of a table. Throws InvalidArgumentError naming a bad number, name or limit.
std::string urdf_of_dh(const DhTable& table);

}  // namespace iksel
