// SPDX-License-Identifier: BSD-3-Clause
// All configurations of a redundant arm that hold a pose: the arcs of its self-motion.
#pragma once

#include <cstdint>
#include <vector>

#include "iksel/export.hpp"
#include "iksel/result.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// What ends an arc of a self-motion.
enum class ArcEnd : std::uint8_t {
  limit,   ///< a joint is at its limit, or some together at a coupled one
  fold,    ///< branches merge in a singularity, from which no way on was found
  closed,  ///< nothing does: the last configuration leads on to the first
};

/// Lower-case name of an end.
IKSEL_EXPORT const char* to_string(ArcEnd end);

/// One end of an arc.
struct SelfMotionEnd {
  /// What ends the arc there.
  ArcEnd kind = ArcEnd::closed;
  /// Index of the joint that is at its limit; -1 unless `limit`.
  int joint = -1;
  /// Whether it is at the upper one of its limits.
  bool at_upper = false;
  /// Index of the coupled limit that is reached, if it is not a joint's own; else -1.
  int coupled_limit = -1;
};

/// A connected piece of the self-motion inside the limits.
struct SelfMotionArc {
  /// Configurations along it, its ends included [rad]; each reaches the pose within the tolerances
  /// and lies inside the limits. A closed arc does not repeat the first. From one to the next no
  /// joint moves farther than asked, but where it has to turn round by a whole turn to stay inside
  /// its limits.
  std::vector<JointVector> q;
  /// The elbow's angle at each, about the line from shoulder to wrist, 0 where the elbow lies in
  /// the plane of that line and the first axis, on the axis' side [rad]; empty unless three axes
  /// meet in a shoulder and three in a wrist. NaN where shoulder and wrist lie on the first axis.
  std::vector<double> elbow;
  /// Sum of the moves along it, each the root of the sum of squares [rad].
  double length = 0;
  SelfMotionEnd begin;  ///< what ends it before its first configuration
  SelfMotionEnd end;    ///< what ends it behind its last configuration

  /// Whether the last configuration leads on to the first.
  [[nodiscard]] bool is_closed() const { return begin.kind == ArcEnd::closed; }
};

/// What Solver::self_motion found.
struct SelfMotion {
  /// `solved` if there is an arc; else why there is none.
  Status status = Status::not_converged;
  /// `answer` if there is an arc; else how certain it is that there is no solution.
  Proof proof = Proof::none;
  /// The longest first. Joints with a range of a whole turn or more end none of them: whole turns
  /// count nothing, and each configuration is given at one of its images.
  std::vector<SelfMotionArc> arcs;

  /// Whether there is at least one arc.
  [[nodiscard]] bool success() const { return status == Status::solved; }
};

}  // namespace iksel
