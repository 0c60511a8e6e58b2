// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/options.hpp>

namespace iksel_headers {

void use_options() {
  iksel::SolverOptions::paper().validate();
  iksel::DatabaseOptions::paper().validate();
  iksel::Lanes().validate();
  iksel::Paper().validate();
}

}  // namespace iksel_headers
