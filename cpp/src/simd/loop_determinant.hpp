// SPDX-License-Identifier: BSD-3-Clause
// The determinant that is 0 where a loop of six joints closes (structure/loop_equations.hpp), for
// angles of one of them.
//
// The six equations are linear in 1, cos, sin of angle d, and of angle e. Multiplied by cos(d / 2)
// and by sin(d / 2) they are twelve, linear and homogeneous in the twelve products of cos(d / 2),
// sin(d / 2), cos(3 d / 2) and sin(3 d / 2) with 1, cos(e) and sin(e).
#pragma once

#include <utility>

#include "simd/branch_arm.hpp"
#include "simd/loop_types.hpp"

namespace iksel::lanes {

inline constexpr int kProducts = 12;

/// By columns: the first index is a product's.
template <typename T>
using Products = T[kProducts][kProducts];

template <typename T>
IKSEL_INLINE void fill_products(const LoopTarget& target, const Angle<T>& angle, Products<T>& m) {
  const T half = T(0.5);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto at = [&](int d) __attribute__((always_inline)) {
        return T(target.equation[0][i][d][j]) + angle.c * T(target.equation[1][i][d][j]) +
               angle.s * T(target.equation[2][i][d][j]);
      };
      const T one = at(0);
      const T c = half * at(1);
      const T s = half * at(2);
      m[j][i] = one + c;
      m[3 + j][i] = s;
      m[6 + j][i] = c;
      m[9 + j][i] = s;
      m[j][6 + i] = s;
      m[3 + j][6 + i] = one - c;
      m[6 + j][6 + i] = T(0.0) - s;
      m[9 + j][6 + i] = c;
    }
  }
}

/// Householder's reflection that leaves nothing below the diagonal of column k. What is reflected
/// stays in registers: its length is known to the compiler.
template <int k, typename T>
IKSEL_INLINE void reflect(Products<T>& m, T& product) {
  constexpr int kRows = kProducts - k;
  const T* own = m[k] + k;
  T square = T(0.0);
  for (int i = 0; i < kRows; ++i) square = square + own[i] * own[i];
  const T norm = sqrt(square);
  const T diagonal = select(own[0] > T(0.0), T(0.0) - norm, norm);
  const T inverse = T(1.0) / max(square + norm * abs(own[0]), T(1e-200));
  m[k][k] = own[0] - diagonal;
  for (int j = k + 1; j < kProducts; ++j) {
    T column[kRows];
    T share = T(0.0);
    for (int i = 0; i < kRows; ++i) {
      column[i] = m[j][k + i];
      share = share + own[i] * column[i];
    }
    share = share * inverse;
    for (int i = 0; i < kRows; ++i) m[j][k + i] = column[i] - share * own[i];
  }
  m[k][k] = diagonal;
  product = product * diagonal;
}

/// Several at once, whose roots and quotients do not wait for each other: each by an odd number of
/// reflections. Returns the products of the diagonals.
template <typename T, int kCount, int... k>
IKSEL_INLINE void make_triangular(Products<T> (&m)[kCount], T (&products)[kCount],
                                  std::integer_sequence<int, k...> /*columns*/) {
  for (T& product : products) product = T(1.0);
  const auto reflect_all = [&](auto column) __attribute__((always_inline)) {
    for (int i = 0; i < kCount; ++i) reflect<decltype(column)::value>(m[i], products[i]);
  };
  (reflect_all(std::integral_constant<int, k>{}), ...);
  for (int i = 0; i < kCount; ++i) {
    products[i] = products[i] * m[i][kProducts - 1][kProducts - 1];
  }
}
template <typename T, int kCount>
IKSEL_INLINE void make_triangular(Products<T> (&m)[kCount], T (&products)[kCount]) {
  make_triangular(m, products, std::make_integer_sequence<int, kProducts - 1>{});
}

/// At so many packs of angles.
template <int kCount, typename T>
IKSEL_INLINE void find_determinants(const LoopTarget& target, const double* angles,
                                    double* values) {
  Products<T> m[kCount];
  T products[kCount];
  for (int i = 0; i < kCount; ++i) {
    Angle<T> angle;
    sincos(Lanes<T>::load(angles + i * Lanes<T>::kCount), angle.s, angle.c);
    fill_products(target, angle, m[i]);
  }
  make_triangular(m, products);
  for (int i = 0; i < kCount; ++i) Lanes<T>::store(products[i], values + i * Lanes<T>::kCount);
}

/// At `n` angles [rad], a multiple of kWidth.
template <typename T>
void find_determinants(const LoopTarget& target, const double* angles, int n, double* values) {
  constexpr int kPack = Lanes<T>::kCount;
  int first = 0;
  for (; first + 2 * kPack <= n; first += 2 * kPack) {
    find_determinants<2, T>(target, angles + first, values + first);
  }
  for (; first < n; first += kPack) {
    find_determinants<1, T>(target, angles + first, values + first);
  }
}

/// So many columns of C = A B, whose sums do not wait for each other.
template <int kColumns, typename T>
IKSEL_INLINE void multiply_columns(const double* A, int rows, const double* B, int inner,
                                   double* C) {
  for (int first = 0; first < rows; first += Lanes<T>::kCount) {
    T sum[kColumns];
    for (int k = 0; k < kColumns; ++k) sum[k] = T(0.0);
    for (int i = 0; i < inner; ++i) {
      const T a = Lanes<T>::load(A + i * rows + first);
      for (int k = 0; k < kColumns; ++k) sum[k] = sum[k] + a * T(B[k * inner + i]);
    }
    for (int k = 0; k < kColumns; ++k) Lanes<T>::store(sum[k], C + k * rows + first);
  }
}

/// C = A B, as Multiply says.
template <typename T>
void multiply(const double* A, int rows, const double* B, int inner, int columns, double* C) {
  int k = 0;
  for (; k + 3 <= columns; k += 3) {
    multiply_columns<3, T>(A, rows, B + k * inner, inner, C + k * rows);
  }
  for (; k < columns; ++k) multiply_columns<1, T>(A, rows, B + k * inner, inner, C + k * rows);
}

/// The determinants by their Fourier coefficients.
template <typename T>
void evaluate_polynomial(const TrigonometricPolynomial& p, const double* angles, int n,
                         double* values) {
  for (int first = 0; first < n; first += Lanes<T>::kCount) {
    Angle<T> z;
    sincos(Lanes<T>::load(angles + first), z.s, z.c);
    T re = T(p.a[TrigonometricPolynomial::kDegree]);
    T im = T(0.0) - T(p.b[TrigonometricPolynomial::kDegree]);
    for (int k = TrigonometricPolynomial::kDegree; k-- > 0;) {
      const T next = T(p.a[k]) + (re * z.c - im * z.s);
      im = re * z.s + im * z.c - T(p.b[k]);
      re = next;
    }
    Lanes<T>::store(re, values + first);
  }
}

}  // namespace iksel::lanes
