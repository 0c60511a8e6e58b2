// SPDX-License-Identifier: BSD-3-Clause
// Which chain of a URDF a robot is, or which chains.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "iksel/coupled_limit.hpp"
#include "iksel/export.hpp"
#include "iksel/mimic_curve.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// Most tips that a robot may have.
inline constexpr int kMaxTips = 8;

/// What to take out of a URDF.
struct RobotOptions {
  /// Link the poses are relative to; empty: the root link.
  std::string base_link;
  /// Link whose pose is solved for; empty: the one link without children, if there is just one.
  std::string tip_link;
  /// T_tip_tcp: tool centre point appended to the tip link. Poses, FK and IK are then of the TCP.
  StoredPose tcp = StoredPose::Identity();
  /// In the place of tip_link for a robot with several tips, whose chains may share joints: a torso
  /// and its two arms. kMaxTips at most.
  std::vector<std::string> tip_links;
  /// In the place of tcp: T_tip_tcp of each of the tip_links, or empty: none has a tool.
  std::vector<StoredPose> tcps;
  /// Joints held at a value [rad or m], by name; they are no degrees of freedom.
  std::map<std::string, double> locked_joints;
  /// Whether the position limits are narrowed to the URDF's safety_controller where there is one.
  bool soft_limits = false;
  /// Lower and upper limit [rad or m] of revolute and prismatic joints whose limits the URDF leaves
  /// out or has as 0, 0; none: such a joint is an error. A mimic joint of that kind has no limits
  /// beside those of the joint that it follows.
  std::optional<std::pair<double, double>> default_limits;
  /// Limits of sums of joint values, beside those of each joint; kMaxCoupledLimits at most.
  std::vector<CoupledLimit> coupled_limits;
  /// How joints follow others where that is no straight line, one for each that does; in the place
  /// of their mimic tags.
  std::vector<MimicCurve> mimic_curves;
};

}  // namespace iksel
