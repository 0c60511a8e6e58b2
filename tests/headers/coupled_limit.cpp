// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/coupled_limit.hpp>

namespace iksel_headers {

void use_coupled_limit(const iksel::CoupledLimit& a, const iksel::CoupledLimit& b) {
  static_assert(iksel::kMaxCoupledLimits > 0);
  static_cast<void>(to_string(a) == to_string(b) && a == b && a != b);
}

}  // namespace iksel_headers
