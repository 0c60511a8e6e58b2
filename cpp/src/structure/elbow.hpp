// SPDX-License-Identifier: BSD-3-Clause
// The elbow of an arm of seven joints with a shoulder and a wrist, in each of which three axes
// meet.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "structure/screw_axes.hpp"

namespace iksel {

class Elbow {
 public:
  /// That of a chain, if it has one.
  static std::optional<Elbow> of(const ChainModel& model);

  /// The angle about the line from shoulder to wrist, from the side of that line where the first
  /// axis points to [rad]; NaN where both lie on the first axis, or the elbow on their line.
  [[nodiscard]] double angle(const double* q) const;
  /// Whether the axes of shoulder and wrist meet at right angles, as exactly as a closed form asks:
  /// then the elbow can turn all the way round the line from shoulder to wrist.
  [[nodiscard]] bool goes_round() const { return goes_round_; }
  /// A value of the first joint with which the second turns the upper arm in a plane with the
  /// wrist, for Y as in reduction.hpp [rad]; half a turn on it is the same plane. As the elbow goes
  /// round, it crosses that plane twice.
  [[nodiscard]] double first_joint_to_plane(const Pose& Y) const;

 private:
  ScrewAxes axes_;
  Eigen::Vector3d shoulder_, elbow_, wrist_;  ///< with all angles at zero [m]
  double offset_[4];
  bool goes_round_ = false;
};

}  // namespace iksel
