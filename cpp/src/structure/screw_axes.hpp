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

/// Two or three axes of a form, one after the other and counted from 0, and how they lie.
struct AxisRun {
  enum class Lie { parallel, meet } lie;  ///< meet: all in one point
  std::size_t first, count;
};

/// How axes have to lie for a closure.
struct AxisRule {
  lanes::Closure closure;
  std::vector<AxisRun> runs;
  std::vector<std::size_t> bends;  ///< axes that are not parallel to the next
};

/// Of all closures but the loop's, what is preferred first.
const std::vector<AxisRule>& axis_rules();

/// Tells how the axes of six joints lie, and moves their points to where they meet.
class AxisPattern {
 public:
  /// `tolerance`: of angles [rad], and of lengths in units of the reach [m].
  AxisPattern(ScrewAxes axes, double reach, double tolerance);

  /// What closes the form, at once or for each angle of a joint that is swept, with the points
  /// where they are to be.
  std::optional<lanes::Closure> find_closure(bool is_swept);

  [[nodiscard]] bool has(const AxisRun& run) const;

  [[nodiscard]] const ScrewAxes& axes() const { return axes_; }
  /// By how much the pose of an arm with the axes as they were moved may differ from that of the
  /// arm as it is [rad, and m in units of the reach]: an axis that is turned by an angle, or
  /// shifted by a distance, moves what is behind it by no more than twice that.
  [[nodiscard]] double deviation() const;
  /// Of axes 2 and 3 from being parallel [rad], and of i and i + 1 from meeting [in units of the
  /// reach].
  [[nodiscard]] double deviation(std::size_t i) const;

 private:
  [[nodiscard]] bool are_parallel(std::size_t i, std::size_t j) const;
  [[nodiscard]] bool is_on(const Eigen::Vector3d& point, std::size_t i) const;
  /// Has all axes take the direction of the first, or the opposite one; or the point where the
  /// first two meet.
  void set_right(const AxisRun& run);

  ScrewAxes given_;
  ScrewAxes axes_;
  double reach_;
  double tolerance_;
};

}  // namespace iksel
