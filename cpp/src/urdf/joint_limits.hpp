// SPDX-License-Identifier: BSD-3-Clause
// The limits of a degree of freedom: its joint's own, and those of the joints that mimic it.
#pragma once

#include <urdf_model/joint.h>

#include "iksel/robot_options.hpp"
#include "urdf/chain_spec.hpp"
#include "urdf/joint_motion.hpp"

namespace iksel {

/// The degree of freedom that a joint is. Throws UrdfError if it has no limits and the options no
/// default ones.
ChainVariable make_variable(const urdf::Joint& joint, const RobotOptions& options);

/// Narrows the limits of `variable` to those of a joint that follows it.
void narrow_by_follower(const urdf::Joint& follower, const Motion& motion,
                        const RobotOptions& options, ChainVariable& variable);

/// Throws UrdfError unless the limits are finite with lower < upper, or the joint is continuous.
void check_limits(const ChainVariable& variable);

/// Throws InvalidArgumentError unless the default limits, if any, are finite with lower < upper.
void check_default_limits(const RobotOptions& options);

}  // namespace iksel
