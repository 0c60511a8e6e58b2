// SPDX-License-Identifier: BSD-3-Clause
#include "structure/loop_polynomial.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace iksel {

LoopPolynomial::LoopPolynomial(const lanes::LaneKernels& kernels) : kernels_(kernels) {
  for (std::size_t i = 0; i < kSamples; ++i) {
    angles_[i] = kTwoPi / kSamples * static_cast<double>(i);
    cosines_[i] = std::cos(angles_[i]);
  }
}

void LoopPolynomial::find(const lanes::LoopTarget& target) {
  constexpr int kDegree = lanes::TrigonometricPolynomial::kDegree;
  std::array<double, kSamples> values;
  kernels_.find_determinants(target, angles_.data(), kSamples, values.data());
  noise_ = 0;
  double squares = 0;
  for (int k = 0; k < kHarmonics; ++k) {
    double a = 0;
    double b = 0;
    for (int i = 0; i < kSamples; ++i) {
      const auto at = static_cast<std::size_t>(i);
      a += values[at] * cosines_[static_cast<std::size_t>(k * i % kSamples)];
      // The cosine a quarter of a turn before.
      b += values[at] * cosines_[static_cast<std::size_t>((k * i + 3 * kSamples / 4) % kSamples)];
    }
    const double share = (k == 0 ? 1.0 : 2.0) / kSamples;
    a *= share;
    b *= share;
    if (k > kDegree) {
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
