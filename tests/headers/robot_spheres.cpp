// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/robot_spheres.hpp>

namespace iksel_headers {

void use_robot_spheres(iksel::RobotSpheres& spheres) {
  spheres.links["tool0"].push_back({{0, 0, 0}, 0.1});
  spheres.validate();
}

}  // namespace iksel_headers
