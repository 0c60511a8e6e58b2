// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/evaluation.hpp>

namespace iksel_headers {

void use_evaluation(const iksel::Solver& solver) {
  const iksel::Evaluation result = iksel::evaluate(solver, 1, 1, /*stages=*/true, {});
  static_cast<void>(result.ratio * iksel::time_kdl_fk_jacobian(solver.robot(), 1));
}

}  // namespace iksel_headers
