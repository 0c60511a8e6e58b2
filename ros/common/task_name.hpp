// SPDX-License-Identifier: BSD-3-Clause
// Tasks by name, in requests and parameters.
#pragma once

#include <iksel/iksel.hpp>
#include <string>

namespace iksel_ros {

/// pose (or empty), position_only, free_spin (about the tip's z axis), upright (any turn about the
/// base's z axis). Throws InvalidArgumentError if it is none of these.
inline iksel::Task task_of(const std::string& name) {
  if (name.empty() || name == "pose") return iksel::Task::pose();
  if (name == "position_only") return iksel::Task::position_only();
  if (name == "free_spin") return iksel::Task::free_spin();
  if (name == "upright") return iksel::Task::upright();
  throw iksel::InvalidArgumentError("task '" + name +
                                    "' is none of pose, position_only, free_spin, upright");
}

}  // namespace iksel_ros
