// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/mimic_curve.hpp>

namespace iksel_headers {

void use_mimic_curve() {
  const auto line = [](double q) { return std::make_pair(2 * q, 2.0); };
  const auto curve = iksel::MimicCurve::sampled("follower", "joint", -1, 1, line);
  static_cast<void>(curve == curve && curve != curve);
}

}  // namespace iksel_headers
