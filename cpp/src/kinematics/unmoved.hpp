// SPDX-License-Identifier: BSD-3-Clause
// What of the tip's pose no joint moves, such as the height of an arm that moves in a plane.
#pragma once

#include <vector>

#include "iksel/pose.hpp"

namespace iksel {

/// Sums of multiples of the coordinates of the TCP's position and of the numbers of its rotation
/// matrix that are the same wherever the joints are.
class Unmoved {
 public:
  Unmoved() = default;
  /// Of a chain whose poses T_base_tcp at random configurations these are. What is constant there
  /// is so everywhere: it is a sum of products of one power, sine or cosine of each joint.
  Unmoved(const std::vector<Pose>& poses, double unit);

  /// Whether it is not known of anything.
  [[nodiscard]] bool is_empty() const { return parts_.empty(); }

  /// Whether no configuration has a pose so near to that one [m, rad]: the part of the difference
  /// from any of the chain's poses that no joint changes is longer than the tolerances allow.
  [[nodiscard]] bool excludes(const Pose& pose, double position, double rotation) const;

 private:
  /// Of the position in the unit, and then the columns of the rotation.
  static constexpr int kNumbers = 12;
  using Numbers = Eigen::Matrix<double, kNumbers, 1, Eigen::DontAlign>;
  [[nodiscard]] Numbers numbers(const Pose& pose) const;
  /// Some of the numbers: of the position, the rotation, or both.
  struct Part {
    bool has_position, has_rotation;
    /// Orthonormal rows, along which the chain does not move.
    Eigen::Matrix<double, Eigen::Dynamic, kNumbers, Eigen::DontAlign, kNumbers, kNumbers> fixed;
  };

  double unit_ = 1;               ///< of lengths [m]
  Numbers at_ = Numbers::Zero();  ///< of one of the chain's poses
  std::vector<Part> parts_;
};

}  // namespace iksel
