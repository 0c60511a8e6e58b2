// SPDX-License-Identifier: BSD-3-Clause
// Which chain of a URDF a robot is.
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

/// What to take out of a URDF.
struct RobotOptions {
  /// Link the poses are relative to; empty: the root link.
  std::string base_link;
  /// Link whose pose is solved for; empty: the one link without children, if there is just one.
  std::string tip_link;
  /// T_tip_tcp: tool centre point appended to the tip link. Poses, FK and IK are then of the TCP.
  StoredPose tcp = StoredPose::Identity();
  /// Joints held at a value [rad or m]; they are no degrees of freedom.
  std::map<std::string, double> locked_joints;
  /// Narrow the position limits to the URDF's safety_controller soft limits where there are any.
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
