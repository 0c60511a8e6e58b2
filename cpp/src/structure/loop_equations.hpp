// SPDX-License-Identifier: BSD-3-Clause
// Six equations for any six joints that turn, by the angles of three of them: Raghavan and Roth,
// "Kinematic analysis of the 6R manipulator of general geometry" (1990).
//
// The joints c, d, e, f, a, b close a loop over the target T: with A_j the motion of joint j,
// A_c A_d A_e A_f A_a A_b = 1 where T^-1 stands behind the first, none, or two or three of them.
// Joint f moves neither a point p on its axis nor its direction l, so that A_c A_d A_e (p, l) =
// A_b^-1 A_a^-1 (p, l). Of a point and a direction, p, p^2, l, p . l, p x l and
// p^2 l - 2 (p . l) p are linear in what they were before a motion, and that is linear in cosine
// and sine of its angle: 14 equations, of which the eight products of 1, cos and sin of a and of b
// leave six.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "simd/loop_types.hpp"
#include "structure/screw_axes.hpp"

namespace iksel {

class LoopEquations {
 public:
  /// Of six axes. `swept`, counted from 0, is joint c: 3, 4, 5 or 0, for which the equations that
  /// lose a and b do not depend on the target. Lengths are divided by `unit` [m].
  LoopEquations(const ScrewAxes& axes, double unit, int swept);

  [[nodiscard]] const lanes::LoopForm& form() const { return form_; }
  /// Of the pose of the last joint's frame.
  void set_target(const Pose& Y, lanes::LoopTarget& target) const;

 private:
  static constexpr int kFeatures = 15;
  static constexpr int kMostPoints = 27;
  using Features = Eigen::Matrix<double, kFeatures, 1>;
  struct Line {
    Eigen::Vector3d p, l;
  };

  [[nodiscard]] Pose motion(int joint, double angle) const;
  /// What is left of equations when products of a and b have gone, by the features of `points_`.
  void eliminate();

  double unit_;
  Pose end_;  ///< [units]
  lanes::LoopForm form_{};
  /// Rows: of the angles of the joints before the target, the first joint's slowest, by what is
  /// constant, goes by cosine and sine; of each six equations.
  Eigen::Matrix<double, Eigen::Dynamic, kFeatures> equations_;
  /// Axis f as the joints behind the target move it, each at three angles, the first's slowest.
  std::vector<Line> points_;
};

}  // namespace iksel
