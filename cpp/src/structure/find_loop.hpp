// SPDX-License-Identifier: BSD-3-Clause
// Which joint of six is swept where the axes lie anyhow.
#pragma once

#include <optional>

#include "structure/closed_form.hpp"

namespace iksel {

/// The six joints in the order of the loop (loop_equations.hpp) from the one that is swept on, as
/// seen from the end from which solutions are told apart the best by that joint's angle; nothing if
/// there is none from which they are: where the axes lie so that several solutions share each of
/// its angles, or that the equations lose more than they may. `model` has six joints that turn.
std::optional<ClosedFormChain> find_loop(const ChainModel& model);

}  // namespace iksel
