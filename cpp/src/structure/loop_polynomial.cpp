// SPDX-License-Identifier: BSD-3-Clause
#include "structure/loop_polynomial.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace iksel {

LoopPolynomial::LoopPolynomial(const lanes::LaneKernels& kernels) : kernels_(kernels) {
  for (int i = 0; i < kSamples; ++i) {
    const double angle = kTwoPi / kSamples * i;
    angles_[static_cast<std::size_t>(i)] = angle;
    for (int k = 0; k < kHarmonics; ++k) {
      const double share = (k == 0 ? 1.0 : 2.0) / kSamples;
      by_harmonics_(2 * k, i) = share * std::cos(k * angle);
      by_harmonics_(2 * k + 1, i) = share * std::sin(k * angle);
    }
  }
}

void LoopPolynomial::find(const lanes::LoopTarget& target) {
  std::array<double, kSamples> values;
  kernels_.find_determinants(target, angles_.data(), kSamples, values.data());
  const Harmonics harmonics = by_harmonics_.lazyProduct(
      Eigen::Map<const Eigen::Matrix<double, kSamples, 1>>(values.data()));
  noise_ = 0;
  double squares = 0;
  for (int k = 0; k < kHarmonics; ++k) {
    const double a = harmonics[2 * k];
    const double b = harmonics[2 * k + 1];
    if (k > lanes::TrigonometricPolynomial::kDegree) {
      noise_ = std::max({noise_, std::abs(a), std::abs(b)});
      continue;
    }
    squares += a * a + b * b;
    polynomial_.a[k] = a;
    polynomial_.b[k] = b;
  }
  size_ = std::sqrt(squares);
}

double LoopPolynomial::slope(double angle) const {
  double slope = 0;
  for (int k = 1; k <= lanes::TrigonometricPolynomial::kDegree; ++k) {
    slope += k * (polynomial_.b[k] * std::cos(k * angle) - polynomial_.a[k] * std::sin(k * angle));
  }
  return slope;
}

}  // namespace iksel
