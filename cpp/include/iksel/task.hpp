// SPDX-License-Identifier: BSD-3-Clause
// What of a pose has to be reached.
#pragma once

#include <array>

#include "iksel/export.hpp"

namespace iksel {

/// Axes that the tolerances of a task lie along.
enum class TaskFrame {
  base,  ///< the base's
  tool,  ///< the target pose's own: those the tool has when it is there
};

/// One axis of a frame.
enum class Axis { x, y, z };

/// What of a pose has to be reached: a box around the target for the deviation of the TCP, along
/// the axes of `frame`. Zero width asks for the axis exactly, infinite width leaves it free.
///
/// The deviation of a TCP at (R, p) from a target (R_t, p_t) has six parts. Position: p - p_t [m].
/// Rotation: that of E = R R_t^T [rad] (in tool axes E = R_t^T R), as the rotation vector of E
/// where the three widths are equal, else as swing and twist, E = swing * twist about the axis
/// whose width is unlike the other two's (of three, the wider odd one). So with a free spin the
/// swing is the angle by which the tool's axis points elsewhere, whatever the spin. An answer lies
/// at most SolverOptions::position_tolerance and ::rotation_tolerance outside of the box, both as
/// norms over their three axes, and inside it along axes wider than two tolerances.
struct IKSEL_EXPORT Task {
  TaskFrame frame = TaskFrame::tool;
  /// Bounds of the position's deviation along x, y, z [m]; infinite: none.
  std::array<double, 3> position_lower{};
  std::array<double, 3> position_upper{};
  /// Bounds of the rotation's deviation about x, y, z [rad], in -pi .. pi, or both infinite: none.
  std::array<double, 3> rotation_lower{};
  std::array<double, 3> rotation_upper{};

  /// The whole pose, exactly.
  [[nodiscard]] static Task pose() { return {}; }
  /// The position; any rotation.
  [[nodiscard]] static Task position_only();
  /// The position and the direction of one of the tool's axes; any spin about it.
  [[nodiscard]] static Task free_spin(Axis axis = Axis::z);
  /// The position, and the rotation up to a turn about one of the base's axes: a glass stays
  /// upright.
  [[nodiscard]] static Task upright(Axis axis = Axis::z);
  /// The position in the plane through the base that `normal` is normal to, and the angle about
  /// `normal`; three axes are left free. For arms that move in a plane.
  [[nodiscard]] static Task planar(Axis normal = Axis::z);
  /// Symmetric tolerances about the target: half widths along x, y, z [m], where infinity leaves an
  /// axis free, and about x, y, z [rad], where pi or more does. Throws InvalidArgumentError about
  /// one that is negative or not a number.
  [[nodiscard]] static Task box(const std::array<double, 3>& position,
                                const std::array<double, 3>& rotation,
                                TaskFrame frame = TaskFrame::tool);

  /// Whether every tolerance is zero.
  [[nodiscard]] bool is_full_pose() const;
  /// Number of axes that are not free, 0 to 6.
  [[nodiscard]] int constrained_axes() const;
  /// Throws InvalidArgumentError naming the first bound that makes no sense.
  void validate() const;

  friend bool operator==(const Task& a, const Task& b) {
    return a.frame == b.frame && a.position_lower == b.position_lower &&
           a.position_upper == b.position_upper && a.rotation_lower == b.rotation_lower &&
           a.rotation_upper == b.rotation_upper;
  }
  friend bool operator!=(const Task& a, const Task& b) { return !(a == b); }
};

}  // namespace iksel
