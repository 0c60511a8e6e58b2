// SPDX-License-Identifier: BSD-3-Clause
// Where the joints of a chain are, lane by lane.
#pragma once

#include "simd/lane_math.hpp"
#include "simd/lane_types.hpp"

namespace iksel::lanes {

/// Frame of the last joint seen from the first: columns and position.
template <typename T>
struct LaneFrame {
  T x[3], y[3], z[3], p[3];
};

/// (u, v) <- (c u + s v, c v - s u)
template <typename T, typename C>
inline void turn(T (&u)[3], T (&v)[3], const C& c, const C& s) {
  for (int i = 0; i < 3; ++i) {
    const T a = u[i];
    u[i] = a * c + v[i] * s;
    v[i] = v[i] * c - a * s;
  }
}

/// Frames of the chain's first n joints, which have the values q: J has each joint's origin and
/// axis, `f` the last one's frame.
template <typename T>
IKSEL_INLINE void place_joints(const LaneChainOf<NumberOf<T>>& chain, const T* q, T (*J)[6],
                               LaneFrame<T>& f, int n) {
  for (int i = 0; i < 3; ++i) {
    f.x[i] = T(i == 0 ? 1.0 : 0.0);
    f.y[i] = T(i == 1 ? 1.0 : 0.0);
    f.z[i] = T(i == 2 ? 1.0 : 0.0);
    f.p[i] = T(0.0);
  }
  // The joints' sines first: they do not depend on each other, and the frames need the registers.
  T sine[kMaxMovingJoints];
  T cosine[kMaxMovingJoints];
  for (int j = 0; j < n; ++j) sincos(q[j] + T(chain.joint[j].offset), sine[j], cosine[j]);
#pragma GCC unroll 10
  for (int j = 0; j < n; ++j) {
    const auto& joint = chain.joint[j];
    if (j > 0) {
      for (int i = 0; i < 3; ++i) {
        f.p[i] = f.p[i] + f.x[i] * T(joint.p[0]) + f.y[i] * T(joint.p[1]) + f.z[i] * T(joint.p[2]);
      }
      turn(f.y, f.z, T(joint.cos_alpha), T(joint.sin_alpha));
    }
    for (int i = 0; i < 3; ++i) J[j][3 + i] = f.z[i];
    if (joint.prismatic) {
      turn(f.x, f.y, T(joint.cos_turn), T(joint.sin_turn));
      const T slide = q[j] + T(joint.offset);
      for (int i = 0; i < 3; ++i) f.p[i] = f.p[i] + f.z[i] * slide;
    } else if (j == 0) {
      f.x[0] = cosine[0];
      f.x[1] = sine[0];
      f.y[0] = T(0.0) - sine[0];
      f.y[1] = cosine[0];
    } else {
      turn(f.x, f.y, cosine[j], sine[j]);
    }
    for (int i = 0; i < 3; ++i) J[j][i] = f.p[i];
  }
}

/// Component i of u x v.
template <typename U, typename V>
IKSEL_INLINE auto cross_at(int i, const U& u, const V& v) {
  return u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
}

/// From a joint's origin and axis to the twist by which it moves a point: its column of a Jacobian.
template <typename T, typename Joint>
IKSEL_INLINE void make_twist(const Joint& joint, const T* point, T (&column)[6]) {
  const T* axis = column + 3;
  if (joint.prismatic) {
    for (int i = 0; i < 3; ++i) {
      column[i] = axis[i];
      column[3 + i] = T(0.0);
    }
  } else {
    const T r[3] = {point[0] - column[0], point[1] - column[1], point[2] - column[2]};
    for (int i = 0; i < 3; ++i) column[i] = cross_at(i, axis, r);
  }
}

/// The same of all joints where some follow others, and how fast they move with their variables q.
template <typename T>
[[gnu::noinline]] void place_following_joints(const LaneChainOf<NumberOf<T>>& chain, const T* q,
                                              T (*J)[6], T* slope, LaneFrame<T>& f) {
  T value[kMaxMovingJoints];
  for (int k = 0; k < chain.joints; ++k) {
    const auto& joint = chain.joint[k];
    slope[k] = T(joint.multiplier * joint.unit);
    value[k] = slope[k] * q[joint.variable];
    if (joint.curve == nullptr) continue;
    NumberOf<T> values[Lanes<T>::kCount];
    NumberOf<T> slopes[Lanes<T>::kCount];
    Lanes<T>::store(q[joint.variable] * T(joint.unit), values);
    for (int lane = 0; lane < Lanes<T>::kCount; ++lane) {
      const MotionCurve::Point point = joint.curve->at(static_cast<double>(values[lane]));
      values[lane] = static_cast<NumberOf<T>>(point.value);
      slopes[lane] = static_cast<NumberOf<T>>(point.slope);
    }
    value[k] = T(joint.multiplier) * Lanes<T>::load(values);
    slope[k] = T(joint.multiplier * joint.unit) * Lanes<T>::load(slopes);
  }
  place_joints(chain, value, J, f, chain.joints);
}

/// From the origins and axes of all joints to the twists by which their variables move a point.
template <typename T>
[[gnu::noinline]] void gather_twists(const LaneChainOf<NumberOf<T>>& chain, const T* slope,
                                     const T* point, T (*J)[6]) {
  T sum[kMaxJoints][6];
  for (int j = 0; j < chain.n; ++j) {
    for (T& each : sum[j]) each = T(0.0);
  }
  for (int k = 0; k < chain.joints; ++k) {
    make_twist(chain.joint[k], point, J[k]);
    T(&to)[6] = sum[chain.joint[k].variable];
    for (int i = 0; i < 6; ++i) to[i] = to[i] + slope[k] * J[k][i];
  }
  for (int j = 0; j < chain.n; ++j) {
    for (int i = 0; i < 6; ++i) J[j][i] = sum[j][i];
  }
}

/// Rows kFirst to kLast - 1 of the lower half of A = J J^T.
template <int kFirst, int kLast, typename T>
inline void multiply_rows(int n, const T (*J)[6], T (&A)[6][6]) {
#pragma GCC unroll 6
  for (int r = kFirst; r < kLast; ++r) {
#pragma GCC unroll 6
    for (int c = 0; c <= r; ++c) A[r][c] = J[0][r] * J[0][c];
  }
#pragma GCC unroll 10
  for (int j = 1; j < n; ++j) {
#pragma GCC unroll 6
    for (int r = kFirst; r < kLast; ++r) {
#pragma GCC unroll 6
      for (int c = 0; c <= r; ++c) A[r][c] = A[r][c] + J[j][r] * J[j][c];
    }
  }
}
/// All of it: few rows at a time stay in registers.
template <typename T>
IKSEL_INLINE void multiply_by_transposed(int n, const T (*J)[6], T (&A)[6][6]) {
  multiply_rows<0, 3>(n, J, A);
  multiply_rows<3, 5>(n, J, A);
  multiply_rows<5, 6>(n, J, A);
}

}  // namespace iksel::lanes
