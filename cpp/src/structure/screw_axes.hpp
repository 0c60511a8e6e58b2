// SPDX-License-Identifier: BSD-3-Clause
// The axes of a chain where all its joints are at zero: what is parallel to what, and what meets
// where. Of a slide the axis is where it moves to.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "kinematics/chain_model.hpp"
#include "simd/branch_types.hpp"

namespace iksel {

/// Axes at a smaller angle are neither parallel nor can it be said where they meet [rad].
inline constexpr double kClearlyNotParallel = 1e-3;

/// Seen from the first joint's frame, or the other way round from the last one's. Angles are the
/// kernel's, q + offset, and so are ways of slides.
struct ScrewAxes {
  std::vector<Eigen::Vector3d> h;  ///< unit vectors
  std::vector<Eigen::Vector3d> p;  ///< a point on each
  Pose end;                        ///< the last joint's frame

  /// `model` is simple (simd/lane_chain.hpp).
  static ScrewAxes of(const ChainModel& model);
  /// The same chain from its end to its beginning: its pose is the inverse, its angles the same.
  [[nodiscard]] ScrewAxes reversed() const;

  /// Sine of the angle between two axes.
  [[nodiscard]] double angle(std::size_t i, std::size_t j) const { return h[i].cross(h[j]).norm(); }
  /// The point halfway between two axes that are not parallel.
  [[nodiscard]] Eigen::Vector3d middle(std::size_t i, std::size_t j) const;
  /// Distance of an axis from a point [m].
  [[nodiscard]] double distance(std::size_t i, const Eigen::Vector3d& point) const {
    return h[i].cross(point - p[i]).norm();
  }
};

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
