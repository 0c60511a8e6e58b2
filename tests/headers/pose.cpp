// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/pose.hpp>

namespace iksel_headers {

void use_pose(const iksel::Pose& pose) {
  const iksel::Pose rigid = iksel::orthonormalized(iksel::check_pose(pose));
  static_cast<void>(iksel::pose_error(pose, rigid).norm() + iksel::rigid_deviation(rigid));
}

}  // namespace iksel_headers
