// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/options.hpp"
#include "options/option_check.hpp"

namespace iksel {

SolverOptions SolverOptions::paper() {
  SolverOptions options;
  options.position_tolerance = 1e-4;
  options.rotation_tolerance = 1e-3;
  options.database = DatabaseOptions::paper();
  options.max_attempts = 2;
  // The reference implementation's "7 iterations" evaluate nine configurations, eight steps apart.
  options.max_iterations = 8;
  options.strategy = Paper{};
  return options;
}

void SolverOptions::validate() const {
  check_range("position_tolerance", position_tolerance, 1e-12, 1e3);
  check_range("rotation_tolerance", rotation_tolerance, 1e-12, 4.0);
  task.validate();
  check_range("max_attempts", max_attempts, 1, 1'000'000);
  check_range("max_iterations", max_iterations, 1, 100'000);
  database.validate();
  std::visit([](const auto& each) { each.validate(); }, strategy);
}

}  // namespace iksel
