// SPDX-License-Identifier: BSD-3-Clause
#include "structure/locked_arms.hpp"

#include <algorithm>
#include <utility>

#include "base/constants.hpp"
#include "simd/lane_chain.hpp"

namespace iksel {
namespace {

LockedArm lock(const ChainModel& whole, int joint, double value, bool is_upper) {
  RobotOptions options = whole.options;
  options.locked_joints[whole.joints.name(joint)] = value;
  options.coupled_limits.clear();
  LockedArm arm;
  arm.model = std::make_shared<const ChainModel>(whole.urdf, options);
  arm.joint = joint;
  arm.value = value;
  arm.is_upper = is_upper;
  arm.pose = find_closed_form(*arm.model);
  if (!arm.pose || arm.pose->is_almost()) arm.residual = find_residual(*arm.model);
  return arm;
}

bool is_exact(const LockedArm& arm) { return arm.pose && !arm.pose->is_almost(); }

}  // namespace

LockedArms LockedArms::of(const ChainModel& whole) {
  LockedArms found;
  const JointSpace& joints = whole.joints;
  if (whole.dof != kCurveJoints || !is_simple(whole)) return found;
  found.are_all = joints.sums.empty();
  bool are_exact = found.are_all;
  for (int j = 0; j < kCurveJoints; ++j) {
    if (joints.type(j) == JointType::continuous || !takes_part_in_self_motion(whole, j)) continue;
    for (const bool is_upper : {false, true}) {
      LockedArm arm = lock(whole, j, is_upper ? joints.upper[j] : joints.lower[j], is_upper);
      are_exact = are_exact && is_exact(arm);
      found.are_all = found.are_all && (arm.pose || arm.residual);
      if (arm.pose || arm.residual) found.arms.push_back(std::move(arm));
    }
  }
  const auto elbow = Elbow::of(whole);
  if (!are_exact || !elbow || !elbow->goes_round()) return found;
  found.are_closed = true;
  const auto is_endless = [&](int j) { return joints.type(j) == JointType::continuous; };
  if ((is_endless(0) || is_endless(2)) && (is_endless(4) || is_endless(6))) {
    LockedArm first = lock(whole, 0, is_endless(0) ? 0.0 : joints.lower[0], false);
    found.are_closed = is_exact(first);
    if (found.are_closed) found.crossing = Crossing{*elbow, std::move(first)};
  }
  return found;
}

}  // namespace iksel
