// SPDX-License-Identifier: BSD-3-Clause
// The axes of a chain where all its joints are at zero: what is parallel to what, and what meets
// where. Of a slide the axis is where it moves to.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "kinematics/chain_model.hpp"

namespace iksel {

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

}  // namespace iksel
