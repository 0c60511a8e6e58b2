// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace iksel {

/// Steps of R_d, whose points x_j = i step_j without whole numbers spread evenly over the cube of
/// that many dimensions: the powers of 1 / phi, phi the real root of x^(d+1) = x + 1 (M. Roberts,
/// "The unreasonable effectiveness of quasirandom sequences", 2018).
inline std::vector<double> low_discrepancy_steps(std::size_t dimensions) {
  const auto d = static_cast<double>(dimensions);
  double phi = 2.0;
  for (int i = 0; i < 64; ++i) phi = std::pow(1.0 + phi, 1.0 / (d + 1.0));
  std::vector<double> steps(dimensions);
  for (std::size_t j = 0; j < dimensions; ++j) {
    steps[j] = std::pow(1.0 / phi, static_cast<double>(j + 1));
  }
  return steps;
}

}  // namespace iksel
