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

/// x rounded to the nearest integer, for |x| < 2^51 (2^22 in single precision): adding 1.5 * 2^52
/// (1.5 * 2^23) pushes the fraction out.
template <typename T>
inline T nearest_integer(const T& x) {
  const T magic(sizeof(NumberOf<T>) == 8 ? 6755399441055744.0 : 12582912.0);
  return (x + magic) - magic;
}

/// Up to this angle sincos() is used [rad]; it is good for larger ones, to 1e8 or so.
inline constexpr double kSincosRange = 1e6;

/// Single-precision sine and cosine to about 1e-7, of angles up to a few thousand: as sincos().
template <typename T>
inline void rough_sincos(const T& x, T& sine, T& cosine) {
  const T n = nearest_integer(x * T(0.31830988618F));
  // pi in three parts, of which the first two have 8 and 11 bits: n times them is exact.
  const T r =
      ((x - n * T(3.140625F)) - n * T(9.67502593994140625e-4F)) - n * T(1.50995799097837e-7F);
  const T half = n * T(0.5F);
  const T parity = half - nearest_integer(half);
  const T sign = T(1.0F) - T(8.0F) * (parity * parity);
  const T r2 = r * r;
  T s = T(-1.0F / 39916800.0F);  // 1/11!
  s = s * r2 + T(1.0F / 362880.0F);
  s = s * r2 + T(-1.0F / 5040.0F);
  s = s * r2 + T(1.0F / 120.0F);
  s = s * r2 + T(-1.0F / 6.0F);
  T c = T(1.0F / 479001600.0F);  // 1/12!
  c = c * r2 + T(-1.0F / 3628800.0F);
  c = c * r2 + T(1.0F / 40320.0F);
  c = c * r2 + T(-1.0F / 720.0F);
  c = c * r2 + T(1.0F / 24.0F);
  c = c * r2 + T(-0.5F);
  sine = sign * (s * r2 * r + r);
  cosine = sign * (c * r2 + T(1.0F));
}

/// Sine and cosine to the last digits or so: x = n pi + r, both Taylor series in r over
/// [-pi/2, pi/2], and the sign (-1)^n.
template <typename T>
inline void sincos(const T& x, T& sine, T& cosine) {
  if constexpr (sizeof(NumberOf<T>) == 4) return rough_sincos(x, sine, cosine);
  const T n = nearest_integer(x * T(0.318309886183790671538));
  // pi in three parts, of which the first two have 30 bits each: n times them is exact.
  const T r = ((x - n * T(3.141592651605606)) - n * T(1.9841871583270443e-09)) -
              n * T(1.034036596358821e-18);
  const T half = n * T(0.5);
  const T parity = half - nearest_integer(half);       // 0 or +-1/2
  const T sign = T(1.0) - T(8.0) * (parity * parity);  // 1 or -1
  const T r2 = r * r;
  T s = T(-1.0 / 121645100408832000.0);  // 1/19!
  s = s * r2 + T(1.0 / 355687428096000.0);
  s = s * r2 + T(-1.0 / 1307674368000.0);
  s = s * r2 + T(1.0 / 6227020800.0);
  s = s * r2 + T(-1.0 / 39916800.0);
  s = s * r2 + T(1.0 / 362880.0);
  s = s * r2 + T(-1.0 / 5040.0);
  s = s * r2 + T(1.0 / 120.0);
  s = s * r2 + T(-1.0 / 6.0);
  T c = T(1.0 / 2432902008176640000.0);  // 1/20!
  c = c * r2 + T(-1.0 / 6402373705728000.0);
  c = c * r2 + T(1.0 / 20922789888000.0);
  c = c * r2 + T(-1.0 / 87178291200.0);
  c = c * r2 + T(1.0 / 479001600.0);
  c = c * r2 + T(-1.0 / 3628800.0);
  c = c * r2 + T(1.0 / 40320.0);
  c = c * r2 + T(-1.0 / 720.0);
  c = c * r2 + T(1.0 / 24.0);
  c = c * r2 + T(-0.5);
  sine = sign * (s * r2 * r + r);
  cosine = sign * (c * r2 + T(1.0));
}

}  // namespace iksel
