// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/path.hpp>

namespace iksel_headers {

void use_path(iksel::PathResult& path) {
  path.q.push_back(iksel::JointVector::Zero(6));
  static_cast<void>(path.success() && to_string(path.status) != nullptr);
}

}  // namespace iksel_headers
