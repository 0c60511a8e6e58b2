// SPDX-License-Identifier: BSD-3-Clause
// The determinant of a loop (loop_determinant.hpp) as the trigonometric polynomial that it is.
#pragma once

#include <Eigen/Core>
#include <array>

#include "simd/kernels.hpp"
#include "simd/loop_types.hpp"

namespace iksel {

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
