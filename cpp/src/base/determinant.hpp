// SPDX-License-Identifier: BSD-3-Clause
// Determinants of 6 x 6 matrices.
#pragma once

#include <cmath>
#include <utility>

namespace iksel {

/// The determinant of a matrix of `rows`, which become its factors: by elimination, the largest of
/// a column first. (Eigen's takes a compiler seconds.)
inline double determinant(double (&rows)[6][6]) {
  double* row[6];
  for (int k = 0; k < 6; ++k) row[k] = rows[k];
  double product = 1;
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    int largest = k;
#pragma GCC unroll 6
    for (int r = k + 1; r < 6; ++r) {
      if (std::abs(row[r][k]) > std::abs(row[largest][k])) largest = r;
    }
    if (largest != k) {
      std::swap(row[k], row[largest]);
      product = -product;
    }
    const double pivot = row[k][k];
    product *= pivot;
    if (product == 0) return 0;
    const double inverse = 1 / pivot;
#pragma GCC unroll 6
    for (int r = k + 1; r < 6; ++r) {
      const double factor = row[r][k] * inverse;
#pragma GCC unroll 6
      for (int i = k + 1; i < 6; ++i) row[r][i] -= factor * row[k][i];
    }
  }
  return product;
}

}  // namespace iksel
