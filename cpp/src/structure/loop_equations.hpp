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
#include <array>

#include "simd/kernels.hpp"
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
  /// What is linear in itself under a motion, 1 among it, and zeros up to whole packs.
  static constexpr int kFeatures = 16;
  static constexpr int kCoefficients = 162;

  [[nodiscard]] Pose motion(int joint, double angle) const;
  /// What is left of equations when products of a and b have gone, by the features of axis f.
  void make_equations();
  /// Features of axis f as the joints behind the target move it.
  void make_points();

  double unit_;
  Pose end_;  ///< [units]
  const lanes::LaneKernels* kernels_;
  lanes::LoopForm form_{};
  /// Rows: of the angles of the joints before the target, the first joint's slowest, by what is
  /// constant, goes by cosine and sine; of each six equations. And zeros up to whole packs.
  Eigen::Matrix<double, Eigen::Dynamic, kFeatures> equations_;
  /// Columns: of the angles of the joints behind the target, in the same way.
  Eigen::Matrix<double, kFeatures, Eigen::Dynamic> points_;
  /// Where their products stand in the target's equations, row by row of each column.
  std::array<unsigned char, kCoefficients> place_{};
};

/// The determinant of a loop (loop_determinant.hpp) as the trigonometric polynomial that it is.
class LoopPolynomial {
 public:
  explicit LoopPolynomial(const lanes::LaneKernels& kernels);

  void find(const lanes::LoopTarget& target);
  [[nodiscard]] const lanes::TrigonometricPolynomial& get() const { return polynomial_; }
  /// What rounding leaves of harmonics that the determinant does not have: the largest of these.
  [[nodiscard]] double noise() const { return noise_; }
  /// The root of the sum of all coefficients' squares.
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] double slope(double angle) const;

 private:
  static constexpr int kSamples = 24;
  static_assert(kSamples % lanes::kWidth == 0);
  static constexpr int kHarmonics = kSamples / 2;

  const lanes::LaneKernels& kernels_;
  std::array<double, kSamples> angles_;
  /// From values at these to what goes by the cosine and the sine of so many times the angle.
  using Harmonics = Eigen::Matrix<double, 2 * kHarmonics, 1>;
  Eigen::Matrix<double, 2 * kHarmonics, kSamples> by_harmonics_;
  lanes::TrigonometricPolynomial polynomial_{};
  double noise_ = 0;
  double size_ = 0;
};

}  // namespace iksel
