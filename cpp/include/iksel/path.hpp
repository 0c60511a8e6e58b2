// SPDX-License-Identifier: BSD-3-Clause
// Joint values along a path of poses (Solver::solve_path).
#pragma once

#include <cstddef>
#include <vector>

#include "iksel/result.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// Joint values along a path.
struct PathResult {
  /// `solved` if there is a configuration for every waypoint. Else why there is none for waypoint
  /// `first_unreachable`: too_fast if it has solutions, but no joint path leads there in time.
  Status status = Status::not_converged;
  /// One configuration per waypoint [rad or m]; if there is none for one, of those before it.
  std::vector<JointVector> q;
  /// Index of the first waypoint that has no continuation; -1 if the path is solved.
  std::ptrdiff_t first_unreachable = -1;
  /// The farthest that a joint moves between two waypoints (or start and the first) [rad or m].
  double largest_step = 0;
  /// Index of the joint that does; -1 if there is no step.
  int largest_step_joint = -1;
  /// Index of the waypoint where that step ends; -1 if there is no step.
  std::ptrdiff_t largest_step_waypoint = -1;
  /// Sum of the moves.
  double move = 0;

  /// Whether there is a configuration for every waypoint.
  [[nodiscard]] bool success() const { return status == Status::solved; }
};

}  // namespace iksel
