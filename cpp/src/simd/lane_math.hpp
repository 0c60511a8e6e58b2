// SPDX-License-Identifier: BSD-3-Clause
// What the lane kernels need of a number type T: a double (one lane) or an xsimd pack.
//
// Nothing here may call an inline function of the standard library or Eigen: the files that include
// it are compiled for one instruction set each, and the linker would be free to take that set's
// copy of such a function for the whole program.
#pragma once

#include <xsimd/xsimd.hpp>

#include "base/sincos.hpp"

/// Parts of a kernel that the compiler would otherwise call, with their vectors in memory.
#define IKSEL_INLINE inline __attribute__((always_inline))

namespace iksel::lanes {

template <typename T>
struct Lanes {
  using Number = NumberOf<T>;
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

IKSEL_INLINE double select(bool mask, double a, double b) { return mask ? a : b; }
IKSEL_INLINE float select(bool mask, float a, float b) { return mask ? a : b; }
IKSEL_INLINE bool any(bool mask) { return mask; }
IKSEL_INLINE double sqrt(double x) { return __builtin_sqrt(x); }
IKSEL_INLINE float sqrt(float x) { return __builtin_sqrtf(x); }
IKSEL_INLINE double max(double a, double b) { return a > b ? a : b; }
IKSEL_INLINE float max(float a, float b) { return a > b ? a : b; }
IKSEL_INLINE double min(double a, double b) { return a < b ? a : b; }
IKSEL_INLINE float min(float a, float b) { return a < b ? a : b; }
IKSEL_INLINE float abs(float x) { return __builtin_fabsf(x); }
IKSEL_INLINE double abs(double x) { return __builtin_fabs(x); }

/// The lanes where a condition holds, as bits.
template <typename T, typename Mask>
IKSEL_INLINE unsigned to_bits(const Mask& condition) {
#ifdef __AVX512F__
  if constexpr (sizeof(Mask) == sizeof(__mmask8) && Lanes<T>::kCount == 8) {
    return static_cast<unsigned>(static_cast<__mmask8>(condition));
  }
#endif
#ifdef __AVX__
  if constexpr (sizeof(Mask) == sizeof(__m256d) && sizeof(NumberOf<T>) == sizeof(double)) {
    return static_cast<unsigned>(_mm256_movemask_pd(condition));
  }
#endif
  unsigned bits = 0;
  if (any(condition)) {
    NumberOf<T> hit[Lanes<T>::kCount];
    Lanes<T>::store(select(condition, T(1.0), T(0.0)), hit);
    for (int lane = 0; lane < Lanes<T>::kCount; ++lane) {
      if (hit[lane] != 0.0) bits |= 1U << static_cast<unsigned>(lane);
    }
  }
  return bits;
}

/// asin(s) / s for 0 <= s <= 1, to 1e-15 (the rational function of Sun's fdlibm, e_asin.c).
template <typename T>
inline T asin_over(const T& s) {
  const auto large = s > T(0.5);
  const T t = select(large, T(0.5) - T(0.5) * s, s * s);
  const T p = polynomial(t, 3.47933107596021167570e-05, 7.91534994289814532176e-04,
                         -4.00555345006794114027e-02, 2.01212532134862925881e-01,
                         -3.25565818622400915405e-01, 1.66666666666666657415e-01);
  const T q = polynomial(t, 7.70381505559019352791e-02, -6.88283971605453293030e-01,
                         2.02094576023350569471e+00, -2.40339491173441421878e+00, 1.0);
  const T r = T(1.0) + p * t / q;
  const T root = sqrt(max(t, T(0.0)));
  return select(large, (T(1.57079632679489661923) - T(2.0) * root * r) / max(s, T(0.5)), r);
}

/// Single-precision atan2 to about 1e-5 rad, which is enough for a seed (Abramowitz and Stegun,
/// 4.4.49).
template <typename T>
inline T rough_atan2(const T& y, const T& x) {
  const T ax = abs(x);
  const T ay = abs(y);
  const T high = max(max(ax, ay), T(1e-30F));
  const T t = min(ax, ay) / high;
  T a = t * polynomial(t * t, 0.0208351F, -0.0851330F, 0.1801410F, -0.3302995F, 0.9998660F);
  a = select(ay > ax, T(1.57079633F) - a, a);
  a = select(x < T(0.0F), T(3.14159265F) - a, a);
  return select(y < T(0.0F), T(0.0F) - a, a);
}

}  // namespace iksel::lanes
