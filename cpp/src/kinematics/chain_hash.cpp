// SPDX-License-Identifier: BSD-3-Clause
#include "base/hash.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

std::uint64_t ChainModel::compute_hash() const {
  // Over what the URDF says, so that the kernel may change its frames without old files going
  // stale.
  Hash64 hasher;
  const auto add_transform = [&](const Eigen::Isometry3d& T) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) hasher.add(T(row, column));
    }
  };
  for (const ChainJoint& joint : spec.joints) {
    add_transform(joint.before);
    add_transform(joint.after);
    for (const bool flag : {joint.fixed, joint.prismatic}) {
      hasher.add(static_cast<std::uint64_t>(flag));
    }
    for (int i = 0; i < 3; ++i) hasher.add(joint.axis[i]);
    hasher.add(static_cast<std::uint64_t>(joint.variable + 1));
    hasher.add(joint.multiplier);
    hasher.add(joint.offset);
    if (!joint.curve) continue;
    for (const auto* numbers :
         {&joint.curve->q(), &joint.curve->values(), &joint.curve->slopes()}) {
      for (const double number : *numbers) hasher.add(number);
    }
  }
  for (int i = 0; i < dof; ++i) {
    hasher.add(joints.lower[i]);
    hasher.add(joints.upper[i]);
  }
  for (const Limit& row : joints.sums) {
    for (int i = 0; i < dof; ++i) hasher.add(row.c[i]);
    hasher.add(row.lower);
    hasher.add(row.upper);
  }
  return hasher.value();
}

}  // namespace iksel
