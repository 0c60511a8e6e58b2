// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/robot_options.hpp>

namespace iksel_headers {

void use_robot_options(iksel::RobotOptions& options) {
  options.tcp = iksel::Pose::Identity();
  options.coupled_limits.push_back({{{"joint", 1.0}}, 0, 1});
  options.mimic_curves.emplace_back();
}

}  // namespace iksel_headers
