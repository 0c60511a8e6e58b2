// SPDX-License-Identifier: BSD-3-Clause
// Which of six axes are parallel and which meet, and what closes the form of such an arm.
#pragma once

#include <optional>

#include "simd/branch_types.hpp"
#include "structure/screw_axes.hpp"

namespace iksel {

/// Tells how the axes of six joints lie, and moves their points to where they meet.
class AxisPattern {
 public:
  /// `tolerance`: of angles [rad], and of lengths in units of the reach [m].
  AxisPattern(ScrewAxes axes, double reach, double tolerance);

  /// What closes the form, with the points where they are to be.
  std::optional<lanes::Closure> find_closure();
  /// What closes it for an angle of one joint.
  std::optional<lanes::Closure> find_sweep();

  [[nodiscard]] bool are_parallel(std::size_t i, std::size_t j) const;
  /// Whether axes i, i + 1 and i + 2 meet in one point.
  [[nodiscard]] bool three_meet(std::size_t i) const;

  [[nodiscard]] const ScrewAxes& axes() const { return axes_; }
  /// By how much the pose of an arm with the axes as they were moved may differ from that of the
  /// arm as it is [rad, and m in units of the reach]: an axis that is turned by an angle, or
  /// shifted by a distance, moves what is behind it by no more than twice that.
  [[nodiscard]] double deviation() const;
  /// Of axes 2 and 3 from being parallel [rad], and of i and i + 1 from meeting [in units of the
  /// reach].
  [[nodiscard]] double deviation(std::size_t i) const;

 private:
  [[nodiscard]] bool meet(std::size_t i, std::size_t j) const;
  [[nodiscard]] bool is_on(const Eigen::Vector3d& point, std::size_t i) const;
  /// Where axes i and i + 1 meet becomes the point on both, and on `more` others.
  void join(std::size_t i, std::size_t more = 0);
  /// Axis j takes the direction of i, or the opposite one.
  void align(std::size_t i, std::size_t j);

  ScrewAxes given_;
  ScrewAxes axes_;
  double reach_;
  double tolerance_;
};

}  // namespace iksel
