// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include "base/error_check.hpp"
#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/request.hpp"

namespace iksel {

void PathOptions::validate(int dof) const {
  SolveRequest request;
  request.near = start;
  request.weights = weights;
  request.norm = norm;
  if (start) check_joints(*start, dof, "start");
  request.validate(dof);
  if (!(dt >= 0 && dt <= 1e9)) {
    throw InvalidArgumentError("dt: " + number_text(dt) + " s is not 0 or more");
  }
  if (candidates < 1 || candidates > 100'000) {
    throw InvalidArgumentError("candidates: " + std::to_string(candidates) +
                               " is not in 1 .. 100000");
  }
}

}  // namespace iksel
