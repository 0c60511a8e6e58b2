// SPDX-License-Identifier: BSD-3-Clause
// Sine and cosine together, for a double or a SIMD pack, by the same few multiply-adds everywhere.
//
// The lane kernels include this file too: nothing of the standard library here (lane_math.hpp).
#pragma once

namespace iksel {

template <typename T>
struct NumberIn {
  using Type = typename T::value_type;
};
template <>
struct NumberIn<double> {
  using Type = double;
};
template <>
struct NumberIn<float> {
  using Type = float;
};
/// double or float: what T is, or a pack of.
template <typename T>
using NumberOf = typename NumberIn<T>::Type;

/// A polynomial in x, by its coefficients from that of the highest power on.
template <typename T, typename First, typename... Rest>
inline __attribute__((always_inline)) T polynomial(const T& x, First first, Rest... rest) {
  T sum(first);
  ((sum = sum * x + T(rest)), ...);
  return sum;
}

/// x rounded to the nearest integer, for |x| < 2^51 (2^22 in single precision): adding 1.5 * 2^52
/// (1.5 * 2^23) pushes the fraction out.
template <typename T>
inline T nearest_integer(const T& x) {
  const T magic(sizeof(NumberOf<T>) == 8 ? 6755399441055744.0 : 12582912.0);
  return (x + magic) - magic;
}

/// Up to this angle sincos() is used [rad]; it is good for larger ones, to 1e8 or so.
inline constexpr double kSincosRange = 1e6;

/// Sine and cosine to the last digits or so, in single precision of angles up to a few thousand:
/// x = n pi + r, both Taylor series in r over [-pi/2, pi/2], and the sign (-1)^n.
template <typename T>
inline void sincos(const T& x, T& sine, T& cosine) {
  const T n = nearest_integer(x * T(0.318309886183790671538));
  const T half = n * T(0.5);
  const T parity = half - nearest_integer(half);       // 0 or +-1/2
  const T sign = T(1.0) - T(8.0) * (parity * parity);  // 1 or -1
  T r, r2, s, c;
  // pi in three parts, of which the first two have 8 and 11 bits, or 30 each: n times them is
  // exact. Then the series from 1 / 11! on and from 1 / 12!, or from 1 / 19! and from 1 / 20!.
  if constexpr (sizeof(NumberOf<T>) == 4) {
    r = ((x - n * T(3.140625F)) - n * T(9.67502593994140625e-4F)) - n * T(1.50995799097837e-7F);
    r2 = r * r;
    s = polynomial(r2, -1.0F / 39916800.0F, 1.0F / 362880.0F, -1.0F / 5040.0F, 1.0F / 120.0F,
                   -1.0F / 6.0F);
    c = polynomial(r2, 1.0F / 479001600.0F, -1.0F / 3628800.0F, 1.0F / 40320.0F, -1.0F / 720.0F,
                   1.0F / 24.0F, -0.5F);
  } else {
    r = ((x - n * T(3.141592651605606)) - n * T(1.9841871583270443e-09)) -
        n * T(1.034036596358821e-18);
    r2 = r * r;
    s = polynomial(r2, -1.0 / 121645100408832000.0, 1.0 / 355687428096000.0, -1.0 / 1307674368000.0,
                   1.0 / 6227020800.0, -1.0 / 39916800.0, 1.0 / 362880.0, -1.0 / 5040.0,
                   1.0 / 120.0, -1.0 / 6.0);
    c = polynomial(r2, 1.0 / 2432902008176640000.0, -1.0 / 6402373705728000.0,
                   1.0 / 20922789888000.0, -1.0 / 87178291200.0, 1.0 / 479001600.0,
                   -1.0 / 3628800.0, 1.0 / 40320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5);
  }
  sine = sign * (s * r2 * r + r);
  cosine = sign * (c * r2 + T(1.0));
}

}  // namespace iksel
