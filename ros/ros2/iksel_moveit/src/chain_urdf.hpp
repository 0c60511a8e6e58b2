// SPDX-License-Identifier: BSD-3-Clause
// A chain of MoveIt's robot model as a URDF.
#pragma once

#include <string>

namespace moveit::core {
class RobotModel;
}

namespace iksel_moveit {

/// The links and joints from `base` down to `tip`, with MoveIt's limits, which may be narrower than
/// those of the URDF that the model was made of. Throws iksel::Error if `base` is not above `tip`,
/// or a joint has more than one variable.
std::string chain_urdf(const moveit::core::RobotModel& model, const std::string& base,
                       const std::string& tip);

}  // namespace iksel_moveit
