// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/iksel.hpp>

namespace iksel_headers {

void use_all(const iksel::Solver& solver, const iksel::Pose& pose) {
  static_cast<void>(iksel::Tracker(solver, solver.solve(pose).q).track(pose, 1).success());
}

}  // namespace iksel_headers
