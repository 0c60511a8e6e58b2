// SPDX-License-Identifier: BSD-3-Clause
#include "structure/locked_arms.hpp"

#include <utility>

#include "simd/lane_chain.hpp"
#include "structure/known_solutions.hpp"

namespace iksel {

LockedArms LockedArms::of(const ChainModel& whole) {
  constexpr int kJoints = 7;
  LockedArms found;
  const JointSpace& joints = whole.joints;
  if (whole.dof != kJoints || !is_simple(whole)) return found;
  found.are_all = joints.coupled.empty();
  for (int j = 0; j < kJoints; ++j) {
    if (joints.type(j) == JointType::continuous || !takes_part_in_self_motion(whole, j)) continue;
    for (const bool is_upper : {false, true}) {
      const double value = is_upper ? joints.upper[j] : joints.lower[j];
      RobotOptions options = whole.options;
      options.locked_joints[joints.name(j)] = value;
      options.coupled_limits.clear();
      LockedArm arm;
      arm.model = std::make_shared<const ChainModel>(whole.urdf, options);
      arm.joint = j;
      arm.value = value;
      arm.is_upper = is_upper;
      arm.pose = find_closed_form(*arm.model);
      if (!arm.pose || arm.pose->is_almost()) arm.residual = find_residual(*arm.model);
      if (arm.pose || arm.residual) {
        found.arms.push_back(std::move(arm));
      } else {
        found.are_all = false;
      }
    }
  }
  return found;
}

}  // namespace iksel
