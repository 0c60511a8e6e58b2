// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/result.hpp>

namespace iksel_headers {

void use_result(const iksel::Result& result, const iksel::Solutions& all) {
  static_cast<void>(to_string(result.status) != to_string(result.proof));
  static_cast<void>(has_joints(all.status) && all.success() && result.success());
  static_cast<void>(sizeof(iksel::StageTimes) + sizeof(iksel::BatchView));
}

}  // namespace iksel_headers
