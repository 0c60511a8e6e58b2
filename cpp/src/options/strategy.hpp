// SPDX-License-Identifier: BSD-3-Clause
// A strategy as the code that takes one seed at a time reads it.
#pragma once

#include "iksel/options.hpp"

namespace iksel {

/// The paper's pipeline, with the settings of Lanes for chains that lanes cannot solve.
Paper one_at_a_time(const Strategy& strategy);

/// Neighbours asked from the database.
inline int neighbours_of(const Strategy& strategy) {
  return std::visit([](const auto& each) { return each.neighbours; }, strategy);
}

}  // namespace iksel
