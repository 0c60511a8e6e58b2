// SPDX-License-Identifier: BSD-3-Clause
// What the lane kernels need of a number type T: a double (one lane) or an xsimd pack.
//
// Nothing here may call an inline function of the standard library or Eigen: the files that include
// it are compiled for one instruction set each, and the linker would be free to take that set's
// copy of such a function for the whole program.
#pragma once

#include <xsimd/xsimd.hpp>

#include "base/sincos.hpp"

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
