// SPDX-License-Identifier: BSD-3-Clause
#include "base/error_check.hpp"

#include <cmath>
#include <string>

#include "iksel/error.hpp"

namespace iksel {

void throw_invalid(const char* name, std::ptrdiff_t index, const std::string& what) {
  std::string text = name;
  if (index >= 0) text += "[" + std::to_string(index) + "]";
  throw InvalidArgumentError(text + ": " + what);
}

void check_joints(const JointVector& q, int dof, const char* name) {
  if (q.size() != dof) {
    throw_invalid(
        name, -1,
        "expected " + std::to_string(dof) + " joint values, got " + std::to_string(q.size()));
  }
  for (int i = 0; i < dof; ++i) {
    if (!std::isfinite(q[i])) throw_invalid(name, i, "not finite");
  }
}

}  // namespace iksel
