// SPDX-License-Identifier: BSD-3-Clause
// Symmetric 6 x 6 systems, for any number type T: a double, or a SIMD pack of one system per lane.
#pragma once

namespace iksel {

/// L D L^T of a positive definite matrix. Everything is unrolled: Eigen's loops take twice as long.
template <typename T>
class SymmetricFactors {
 public:
  /// Of A + lambda I; of A the lower half is read. It is the caller's, who needs it no more, and
  /// becomes L.
  SymmetricFactors(T (&A)[6][6], const T& lambda) : L_(A) {
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) {
      T d = L_[j][j] + lambda;
      T scaled[6];
#pragma GCC unroll 6
      for (int k = 0; k < j; ++k) {
        scaled[k] = L_[j][k];
        L_[j][k] = L_[j][k] * inverse_[k];
        d = d - L_[j][k] * scaled[k];
      }
      inverse_[j] = T(1.0) / d;
#pragma GCC unroll 6
      for (int i = j + 1; i < 6; ++i) {
        T v = L_[i][j];
#pragma GCC unroll 6
        for (int k = 0; k < j; ++k) v = v - L_[i][k] * L_[j][k];
        L_[i][j] = v;
      }
    }
  }

  /// y, of which the system makes b.
  void solve(const T (&b)[6], T (&y)[6]) const {
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i) {
      T v = b[i];
#pragma GCC unroll 6
      for (int k = 0; k < i; ++k) v = v - L_[i][k] * y[k];
      y[i] = v;
    }
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i) y[i] = y[i] * inverse_[i];
#pragma GCC unroll 6
    for (int i = 5; i >= 0; --i) {
#pragma GCC unroll 6
      for (int k = i + 1; k < 6; ++k) y[i] = y[i] - L_[k][i] * y[k];
    }
  }

  /// Of A + lambda I; of a singular one next to nothing, or NaN.
  [[nodiscard]] T determinant() const {
    T product(1.0);
    for (const T& each : inverse_) product = product / each;
    return product;
  }

 private:
  T (&L_)[6][6];
  T inverse_[6];
};

}  // namespace iksel
