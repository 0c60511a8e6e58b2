// SPDX-License-Identifier: BSD-3-Clause
// Vectors in space, lane by lane.
#pragma once

#include "simd/lane_math.hpp"

namespace iksel::lanes {

template <typename T>
struct Vec {
  T x, y, z;
};

template <typename T>
IKSEL_INLINE Vec<T> constant(const double (&v)[3]) {
  return {T(v[0]), T(v[1]), T(v[2])};
}
template <typename T>
IKSEL_INLINE T dot(const Vec<T>& a, const Vec<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
IKSEL_INLINE Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
IKSEL_INLINE Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename T>
IKSEL_INLINE Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
/// a + s b
template <typename T>
IKSEL_INLINE Vec<T> add(const Vec<T>& a, const T& s, const Vec<T>& b) {
  return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
template <typename T>
IKSEL_INLINE Vec<T> scaled(const T& s, const Vec<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
/// M a
template <typename T>
IKSEL_INLINE Vec<T> times(const NumberOf<T> (&M)[3][3], const Vec<T>& a) {
  return {T(M[0][0]) * a.x + T(M[0][1]) * a.y + T(M[0][2]) * a.z,
          T(M[1][0]) * a.x + T(M[1][1]) * a.y + T(M[1][2]) * a.z,
          T(M[2][0]) * a.x + T(M[2][1]) * a.y + T(M[2][2]) * a.z};
}

}  // namespace iksel::lanes
