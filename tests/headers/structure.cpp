// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/structure.hpp>

namespace iksel_headers {

void use_structure(const iksel::Robot& robot) {
  static_cast<void>(to_string(iksel::find_structure(robot).kind));
}

}  // namespace iksel_headers
