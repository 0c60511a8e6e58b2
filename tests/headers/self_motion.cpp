// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/self_motion.hpp>

namespace iksel_headers {

void use_self_motion(const iksel::SelfMotion& motion) {
  if (!motion.success() || motion.arcs[0].is_closed()) return;
  static_cast<void>(to_string(motion.arcs[0].begin.kind) != to_string(motion.status));
}

}  // namespace iksel_headers
