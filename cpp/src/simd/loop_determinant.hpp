// SPDX-License-Identifier: BSD-3-Clause
// The determinant that is 0 where a loop of six joints closes (structure/loop_equations.hpp), for
// angles of one of them.
//
// The six equations are linear in 1, cos, sin of angle d, and of angle e: with c and s the cosine
// and sine of d / 2 each is A0 c^2 + A1 c s + A2 s^2, linear in 1, cos(e) and sin(e). Multiplied by
// c and by s they are twelve, linear and homogeneous in the products of c^3, c^2 s, c s^2 and s^3
// with those three:
//   | A0  A1  A2  0  |
//   | 0   A0  A1  A2 |
// Each half alone has three of the products, and leaves three equations in the six between.
#pragma once

#include <utility>

#include "simd/branch_arm.hpp"
#include "simd/loop_types.hpp"

namespace iksel::lanes {

/// As many products as equations are in both halves; so many more are one half's own.
inline constexpr int kAlone = 3;

/// So many columns of six equations: the first index is a product's.
template <typename T, int kColumns>
using Columns = T[kColumns][kEquations];

/// The equations times c, of c^3, c^2 s and c s^2; those times s, of s^3, c^2 s and c s^2; and what
/// these leave of the products between.
template <typename T>
struct Products {
  Columns<T, kAlone + kEquations> half[2];
  Columns<T, kEquations> rest;
};

template <typename T>
IKSEL_INLINE void fill_products(const LoopTarget& target, const Angle<T>& angle, Products<T>& m) {
  for (int i = 0; i < kEquations; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto at = [&](int d) __attribute__((always_inline)) {
        return T(target.equation[0][i][d][j]) + angle.c * T(target.equation[1][i][d][j]) +
               angle.s * T(target.equation[2][i][d][j]);
      };
      const T one = at(0);
      const T cosine = at(1);
      const T sine = at(2);
      m.half[0][j][i] = m.half[1][3 + j][i] = one + cosine;
      m.half[0][3 + j][i] = m.half[1][6 + j][i] = sine + sine;
      m.half[0][6 + j][i] = m.half[1][j][i] = one - cosine;
    }
  }
}

/// Householder's reflection that leaves nothing below the diagonal of column k. What is reflected
/// stays in registers: its length is known to the compiler.
template <int k, typename T, int kColumns>
IKSEL_INLINE void reflect(Columns<T, kColumns>& m, T& product) {
  constexpr int kRows = kEquations - k;
  const T* own = m[k] + k;
  T square = T(0.0);
  for (int i = 0; i < kRows; ++i) square = square + own[i] * own[i];
  const T norm = sqrt(square);
  const T diagonal = select(own[0] > T(0.0), T(0.0) - norm, norm);
  const T inverse = T(1.0) / max(square + norm * abs(own[0]), T(1e-200));
  m[k][k] = own[0] - diagonal;
  for (int j = k + 1; j < kColumns; ++j) {
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

/// Both halves and their rest, of several at once, whose roots and quotients do not wait for each
/// other: each by an odd number of reflections. Returns the products of the diagonals.
template <typename T, int kCount, int... own, int... k>
IKSEL_INLINE void make_triangular(Products<T> (&m)[kCount], T (&products)[kCount],
                                  std::integer_sequence<int, own...> /*own columns*/,
                                  std::integer_sequence<int, k...> /*the others*/) {
  for (T& product : products) product = T(1.0);
  const auto reflect_halves = [&](auto column) __attribute__((always_inline)) {
    for (int i = 0; i < kCount; ++i) {
      for (auto& half : m[i].half) reflect<decltype(column)::value>(half, products[i]);
    }
  };
  (reflect_halves(std::integral_constant<int, own>{}), ...);
  for (int i = 0; i < kCount; ++i) {
    for (int j = 0; j < kEquations; ++j) {
      for (int row = 0; row < kEquations; ++row) {
        m[i].rest[j][row] = m[i].half[row / kAlone][kAlone + j][kAlone + row % kAlone];
      }
    }
  }
  const auto reflect_rest = [&](auto column) __attribute__((always_inline)) {
    for (int i = 0; i < kCount; ++i) {
      reflect<decltype(column)::value>(m[i].rest, products[i]);
    }
  };
  (reflect_rest(std::integral_constant<int, k>{}), ...);
  for (int i = 0; i < kCount; ++i) {
    products[i] = products[i] * m[i].rest[kEquations - 1][kEquations - 1];
  }
}
template <typename T, int kCount>
IKSEL_INLINE void make_triangular(Products<T> (&m)[kCount], T (&products)[kCount]) {
  make_triangular(m, products, std::make_integer_sequence<int, kAlone>{},
                  std::make_integer_sequence<int, kEquations - 1>{});
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
  using L = Lanes<T>;
  int first = 0;
  for (; first + 2 * L::kCount <= n; first += 2 * L::kCount) {
    find_determinants<2, T>(target, angles + first, values + first);
  }
  for (; first < n; first += L::kCount) {
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
