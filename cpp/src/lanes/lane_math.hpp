// SPDX-License-Identifier: BSD-3-Clause
// What the lane kernels need of a number type T: a double (one lane) or an xsimd pack.
//
// Nothing here may call an inline function of the standard library or Eigen: the files that include
// it are compiled for one instruction set each, and the linker would be free to take that set's
// copy of such a function for the whole program.
#pragma once

#include <xsimd/xsimd.hpp>

namespace iksel::lanes {

template <typename T>
struct Lanes {
  using Number = typename T::value_type;
  static constexpr int kCount = static_cast<int>(T::size);
  static T load(const Number* p) { return T::load_unaligned(p); }
  static void store(const T& v, Number* p) { v.store_unaligned(p); }
};

/// One lane.
template <typename N>
struct OneLane {
  using Number = N;
  static constexpr int kCount = 1;
  static N load(const N* p) { return *p; }
  static void store(N v, N* p) { *p = v; }
};
template <>
struct Lanes<double> : OneLane<double> {};
template <>
struct Lanes<float> : OneLane<float> {};

inline double select(bool mask, double a, double b) { return mask ? a : b; }
inline float select(bool mask, float a, float b) { return mask ? a : b; }
inline bool any(bool mask) { return mask; }
inline double sqrt(double x) { return __builtin_sqrt(x); }
inline float sqrt(float x) { return __builtin_sqrtf(x); }
inline double max(double a, double b) { return a > b ? a : b; }
inline float max(float a, float b) { return a > b ? a : b; }
inline double min(double a, double b) { return a < b ? a : b; }
inline float min(float a, float b) { return a < b ? a : b; }
inline float abs(float x) { return __builtin_fabsf(x); }

/// x rounded to the nearest integer, for |x| < 2^51 (2^22 in single precision): adding 1.5 * 2^52
/// (1.5 * 2^23) pushes the fraction out.
template <typename T>
inline T nearest_integer(const T& x) {
  const T magic(sizeof(typename Lanes<T>::Number) == 8 ? 6755399441055744.0 : 12582912.0);
  return (x + magic) - magic;
}

/// Sine and cosine to about 5e-14: x = n pi + r, both series in r over [-pi/2, pi/2], and the sign
/// (-1)^n. Good for |x| up to 1e6; the answer of a solve is checked by the exact functions anyway.
template <typename T>
inline void sincos(const T& x, T& sine, T& cosine) {
  const T n = nearest_integer(x * T(0.318309886183790671538));
  // pi in two parts; n * high is exact for |n| < 2^21.
  const T r = (x - n * T(3.14159265160560607910)) - n * T(1.98418714791870343106e-9);
  const T half = n * T(0.5);
  const T parity = half - nearest_integer(half);       // 0 or +-1/2
  const T sign = T(1.0) - T(8.0) * (parity * parity);  // 1 or -1
  const T r2 = r * r;
  T s = T(1.0 / 355687428096000.0);  // 1/17!
  s = s * r2 + T(-1.0 / 1307674368000.0);
  s = s * r2 + T(1.0 / 6227020800.0);
  s = s * r2 + T(-1.0 / 39916800.0);
  s = s * r2 + T(1.0 / 362880.0);
  s = s * r2 + T(-1.0 / 5040.0);
  s = s * r2 + T(1.0 / 120.0);
  s = s * r2 + T(-1.0 / 6.0);
  s = s * r2 + T(1.0);
  T c = T(-1.0 / 6402373705728000.0);  // 1/18!
  c = c * r2 + T(1.0 / 20922789888000.0);
  c = c * r2 + T(-1.0 / 87178291200.0);
  c = c * r2 + T(1.0 / 479001600.0);
  c = c * r2 + T(-1.0 / 3628800.0);
  c = c * r2 + T(1.0 / 40320.0);
  c = c * r2 + T(-1.0 / 720.0);
  c = c * r2 + T(1.0 / 24.0);
  c = c * r2 + T(-0.5);
  c = c * r2 + T(1.0);
  sine = sign * (s * r);
  cosine = sign * c;
}

/// Single-precision atan2 to about 1e-5 rad, which is enough for a seed (Abramowitz and Stegun,
/// 4.4.49).
template <typename T>
inline T rough_atan2(const T& y, const T& x) {
  const T ax = abs(x);
  const T ay = abs(y);
  const T high = max(max(ax, ay), T(1e-30F));
  const T t = min(ax, ay) / high;
  const T t2 = t * t;
  T a = T(0.0208351F);
  a = a * t2 + T(-0.0851330F);
  a = a * t2 + T(0.1801410F);
  a = a * t2 + T(-0.3302995F);
  a = a * t2 + T(0.9998660F);
  a = a * t;
  a = select(ay > ax, T(1.57079633F) - a, a);
  a = select(x < T(0.0F), T(3.14159265F) - a, a);
  return select(y < T(0.0F), T(0.0F) - a, a);
}

}  // namespace iksel::lanes
