// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/types.hpp>

namespace iksel_headers {

void use_types(const iksel::Progress& progress) {
  const iksel::JointVector q = iksel::JointVector::Zero(iksel::kMaxDof);
  const iksel::Pose pose = iksel::StoredPose::Identity() * iksel::Pose::Identity();
  const iksel::Matrix matrix = iksel::Jacobian::Zero(6, q.size()) * q * pose(0, 0);
  progress(static_cast<std::size_t>(matrix.size()), 1);
  static_assert(iksel::JointType::revolute != iksel::JointType::prismatic);
  static_assert(iksel::Kinematics::kdl != iksel::Kinematics::kernel);
  static_assert(iksel::kMaxCoordinate > iksel::kRigidTolerance);
}

}  // namespace iksel_headers
