// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/request.hpp"

namespace iksel {

void SolveAllOptions::validate() const {
  if (max < 1) throw InvalidArgumentError("max: " + std::to_string(max) + " is less than 1");
  if (!(min_distance > 0 && min_distance <= 1e3)) {
    throw InvalidArgumentError("min_distance: " + number_text(min_distance) +
                               " is not above 0 and at most 1000");
  }
  if (order != SolutionOrder::move && order != SolutionOrder::limit_distance &&
      order != SolutionOrder::manipulability) {
    throw InvalidArgumentError(
        "order: not a value of SolutionOrder (move, limit_distance, manipulability)");
  }
}

}  // namespace iksel
