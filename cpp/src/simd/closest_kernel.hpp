// SPDX-License-Identifier: BSD-3-Clause
// Seeds moved towards where the least is missing of a pose that may have no answer: Newton's method
// on
//   C = 1/2 d . W d + 1/2 w^2 F(s),  d = p - t,  s = trace A - trace M,  M = R B,
// for the TCP p and the last joint's rotation R; B has the target's rotation and A the weights of
// its axes, relative to w^2 (ClosestTarget). Of equal weights A is the identity, s the square of
// 2 sin(angle / 2), and F(s) the angle's. Damped as Levenberg-Marquardt, with the limits as an
// active set. For joints i <= j with axes z, velocities L of the TCP and v with s_j = -z_j . v:
//   C_j = L_j . W d + 1/2 w^2 F' s_j
//   C_ij = L_j . (W L_i + W d x z_i) + 1/2 w^2 (F' s_ij + F'' s_i s_j),
//   s_ij = z_i . z_j trace M - z_i . M z_j.
#pragma once

#include "base/constants.hpp"
#include "simd/lane_frames.hpp"
#include "simd/lane_types.hpp"
#include "simd/lane_vector.hpp"
#include "simd/limit_kernel.hpp"

namespace iksel::lanes {

/// What is missing at a frame.
template <typename T>
struct Remaining {
  Vec<T> p;     ///< TCP
  Vec<T> pull;  ///< W d
  Vec<T> v;
  Vec<T> M[3];  ///< rows
  T trace;
  T slope, bend;  ///< 1/2 w^2 F' and 1/2 w^2 F''
  T value;        ///< C
};

/// The angle's square F of s = 4 sin(angle / 2)^2, and its two derivatives.
template <typename T>
IKSEL_INLINE void square_angle(const T& s, T& F, T& slope, T& bend) {
  // Short of half a turn, where the second derivative has no end.
  const T inside = min(max(s, T(0.0F)), T(3.996F));
  const T half = sqrt(T(0.25F) * inside);
  const T over = asin_over(half);
  const T rest = T(1.0F) - T(0.25F) * inside;
  F = inside * over * over;
  slope = over / sqrt(rest);
  const T series = T(1.0F / 6.0F) + inside * (T(1.0F / 15.0F) + inside * T(3.0F / 140.0F));
  const T sine2 = inside * rest;
  const T cosine = T(1.0F) - T(0.5F) * inside;
  bend =
      select(inside < T(0.1F), series, T(0.5F) * (T(1.0F) - slope * cosine) / max(sine2, T(1e-3F)));
}

template <typename T>
IKSEL_INLINE void measure_remaining(const LaneFrame<T>& f, const ClosestTarget& target,
                                    Remaining<T>& out) {
  T p[3];
  T v[3];
  T M[3][3];
  for (int i = 0; i < 3; ++i) {
    p[i] =
        f.p[i] + f.x[i] * T(target.tcp[0]) + f.y[i] * T(target.tcp[1]) + f.z[i] * T(target.tcp[2]);
    for (int k = 0; k < 3; ++k) {
      M[i][k] = f.x[i] * T(target.rotation[0][k]) + f.y[i] * T(target.rotation[1][k]) +
                f.z[i] * T(target.rotation[2][k]);
    }
  }
  for (int i = 0; i < 3; ++i) {
    const int a = (i + 1) % 3;
    const int b = (i + 2) % 3;
    v[i] = M[a][b] - M[b][a];
    out.M[i] = {M[i][0], M[i][1], M[i][2]};
  }
  out.p = {p[0], p[1], p[2]};
  out.v = {v[0], v[1], v[2]};
  out.trace = M[0][0] + M[1][1] + M[2][2];
  const Vec<T> d{p[0] - T(target.position[0]), p[1] - T(target.position[1]),
                 p[2] - T(target.position[2])};
  out.pull = times(target.metric, d);
  T F;
  square_angle(T(target.trace) - out.trace, F, out.slope, out.bend);
  const T half = T(0.5F * target.rotation2);
  out.slope = half * out.slope;
  out.bend = half * out.bend;
  out.value = T(0.5F) * dot(d, out.pull) + half * F;
}

/// What a joint does to the remainder.
template <typename T>
struct JointEffect {
  Vec<T> L, z;
  Vec<T> moved;   ///< W L_i + W d x z_i
  Vec<T> turned;  ///< so that z_j . turned is the rotation's part of C_ij
  T slope;
  T scale;
};

template <typename T>
IKSEL_INLINE JointEffect<T> find_effect(bool is_slide, const Remaining<T>& at,
                                        const ClosestTarget& target, const T (&J)[6]) {
  JointEffect<T> out;
  const Vec<T> axis{J[3], J[4], J[5]};
  if (is_slide) {
    out.L = axis;
    out.z = {T(0.0F), T(0.0F), T(0.0F)};
  } else {
    out.L = cross(axis, {at.p.x - J[0], at.p.y - J[1], at.p.z - J[2]});
    out.z = axis;
  }
  const T along = dot(out.z, at.v);
  const Vec<T> weighted = times(target.metric, out.L);
  out.slope = dot(out.L, at.pull) - at.slope * along;
  out.scale = dot(out.L, weighted) + T(target.rotation2) * dot(out.z, out.z);
  out.moved = add(weighted, T(1.0F), cross(at.pull, out.z));
  // M^T z
  const Vec<T> back = add(add(scaled(out.z.x, at.M[0]), out.z.y, at.M[1]), out.z.z, at.M[2]);
  out.turned =
      add(scaled(at.slope, add(scaled(at.trace, out.z), T(-1.0F), back)), at.bend * along, at.v);
  return out;
}

/// Solves H y = x into x, the lower half of H as L D L^T. Pivots that are not positive are turned
/// round, so that the step descends. Unrolled, as n is known to the compiler in most cases: that
/// makes the whole kernel a fifth faster.
template <typename T>
IKSEL_INLINE void solve_downhill(int n, const T* scale, T (*H)[kMaxJoints], T* x) {
  T inverse[kMaxJoints];
#pragma GCC unroll 8
  for (int j = 0; j < n; ++j) {
    T d = H[j][j];
    T before[kMaxJoints];
#pragma GCC unroll 8
    for (int k = 0; k < j; ++k) {
      before[k] = H[j][k];
      H[j][k] = H[j][k] * inverse[k];
      d = d - H[j][k] * before[k];
    }
    inverse[j] = T(1.0F) / max(abs(d), T(1e-3F) * scale[j] + T(1e-9F));
#pragma GCC unroll 8
    for (int i = j + 1; i < n; ++i) {
#pragma GCC unroll 8
      for (int k = 0; k < j; ++k) H[i][j] = H[i][j] - H[i][k] * H[j][k];
    }
  }
  // By columns: the entries of x then wait for one product each, not for a row's.
#pragma GCC unroll 8
  for (int k = 0; k < n; ++k) {
#pragma GCC unroll 8
    for (int i = k + 1; i < n; ++i) x[i] = x[i] - H[i][k] * x[k];
  }
#pragma GCC unroll 8
  for (int i = 0; i < n; ++i) x[i] = x[i] * inverse[i];
#pragma GCC unroll 8
  for (int k = n - 1; k >= 0; --k) {
#pragma GCC unroll 8
    for (int i = 0; i < k; ++i) x[i] = x[i] - H[k][i] * x[k];
  }
}

/// C's derivatives by the variables, of the second ones the lower half, and what these are damped
/// by. `J` has the origins and axes of so many joints. They are the variables, or if they follow
/// these, their axes are as long as they move with them.
template <bool kFollow, typename T>
IKSEL_INLINE void differentiate(const LaneChainOf<float>& chain, const ClosestTarget& target,
                                const Remaining<T>& at, int joints, const T (*J)[6], T* slope,
                                T* scale, T (*H)[kMaxJoints]) {
  for (int j = 0; kFollow && j < chain.n; ++j) {
    slope[j] = scale[j] = T(0.0F);
    for (int i = 0; i <= j; ++i) H[j][i] = T(0.0F);
  }
  Vec<T> moved[kMaxMovingJoints];
  Vec<T> turned[kMaxMovingJoints];
#pragma GCC unroll 8
  for (int k = 0; k < joints; ++k) {
    const JointEffect<T> effect = find_effect(chain.joint[k].prismatic, at, target, J[k]);
    moved[k] = effect.moved;
    turned[k] = effect.turned;
    const auto with = [&](int i) { return dot(effect.L, moved[i]) + dot(effect.z, turned[i]); };
    if constexpr (!kFollow) {
      slope[k] = effect.slope;
      scale[k] = effect.scale;
#pragma GCC unroll 8
      for (int i = 0; i <= k; ++i) H[k][i] = with(i);
    } else {
      const int b = chain.joint[k].variable;
      slope[b] = slope[b] + effect.slope;
      scale[b] = scale[b] + effect.scale;
      for (int i = 0; i <= k; ++i) {
        const int a = chain.joint[i].variable;
        T& entry = a < b ? H[b][a] : H[a][b];
        entry = entry + T(a == b && i < k ? 2.0F : 1.0F) * with(i);
      }
    }
  }
}

/// The step of Newton's method from q, of n variables, at most kLongestStep in each. `J` as above.
template <bool kFollow, typename T>
IKSEL_INLINE void step_to_closest(const LaneChainOf<float>& chain, const ClosestTarget& target,
                                  const Remaining<T>& at, const T& damping, int n, const T* q,
                                  const T (*J)[6], T* step) {
  const T most(static_cast<float>(kLongestStep));
  T H[kMaxJoints][kMaxJoints];
  T slope[kMaxJoints];
  T scale[kMaxJoints];
  differentiate<kFollow>(chain, target, at, kFollow ? chain.joints : n, J, slope, scale, H);
  if (chain.sums > 0) hold_descent(chain, q, scale, slope, H);
  T free[kMaxJoints];
#pragma GCC unroll 8
  for (int j = 0; j < n; ++j) {
    const auto& variable = chain.variable[j];
    free[j] = T(1.0F);
    if (variable.limited) {
      const auto leaves = ((q[j] <= T(variable.lower)) & (slope[j] > T(0.0F))) |
                          ((q[j] >= T(variable.upper)) & (slope[j] < T(0.0F)));
      free[j] = select(leaves, T(0.0F), T(1.0F));
    }
    step[j] = T(0.0F) - slope[j] * free[j];
#pragma GCC unroll 8
    for (int i = 0; i <= j; ++i) H[j][i] = H[j][i] * free[i] * free[j];
    H[j][j] = H[j][j] + (T(1.0F) - free[j]) + damping * scale[j] + T(1e-9F);
  }
  solve_downhill(n, scale, H, step);
  T longest = most;
#pragma GCC unroll 8
  for (int j = 0; j < n; ++j) longest = max(longest, abs(step[j]));
  const T part = most / longest;
#pragma GCC unroll 8
  for (int j = 0; j < n; ++j) step[j] = step[j] * part;
}

/// `approach` for chains of so many variables; of any number, if that is 0.
template <int kCount, bool kFollow, typename T>
void approach_of(const LaneChainOf<float>& chain, const ClosestTarget& target, int iterations,
                 float* seeds, float* remainder) {
  const int n = kCount > 0 ? kCount : chain.n;
  for (int first = 0; first < kBlock; first += Lanes<T>::kCount) {
    T q[kMaxJoints];
    T best_q[kMaxJoints];
    for (int j = 0; j < n; ++j) best_q[j] = q[j] = Lanes<T>::load(seeds + j * kBlock + first);
    T best = T(1e30F);
    T damping = T(1e-2F);
    for (int iteration = 0;; ++iteration) {
      T J[kMaxMovingJoints][6];
      LaneFrame<T> frame;
      if constexpr (!kFollow) {
        place_joints(chain, q, J, frame, n);
      } else {
        T speed[kMaxMovingJoints];
        place_following_joints(chain, q, J, speed, frame);
        for (int k = 0; k < chain.joints; ++k) {
          for (int i = 3; i < 6; ++i) J[k][i] = J[k][i] * speed[k];
        }
      }
      Remaining<T> at;
      measure_remaining(frame, target, at);
      // Where a sum could not be brought inside it is no place to be.
      if (chain.sums > 0) {
        at.value = select(excess_of_sums(chain, q) > T(0.0F), T(1e29F), at.value);
      }
      // A lane that got worse goes back, and tries again from there with a shorter step.
      const auto better = at.value <= best;
      best = select(better, at.value, best);
      for (int j = 0; j < n; ++j) best_q[j] = select(better, q[j], best_q[j]);
      if (iteration == iterations) break;
      T step[kMaxJoints];
      step_to_closest<kFollow>(chain, target, at, damping, n, q, J, step);
      damping = select(better, max(damping * T(0.2F), T(1e-6F)), min(damping * T(16.0F), T(1e3F)));
      for (int j = 0; j < n; ++j) {
        const auto& variable = chain.variable[j];
        q[j] = select(better, q[j] + step[j], best_q[j]);
        if (variable.limited) q[j] = min(max(q[j], T(variable.lower)), T(variable.upper));
      }
      if (chain.sums > 0) hold_sums(chain, q);
    }
    for (int j = 0; j < n; ++j) Lanes<T>::store(best_q[j], seeds + j * kBlock + first);
    Lanes<T>::store(best, remainder + first);
  }
}

template <typename T>
void approach(const LaneChainOf<float>& chain, const ClosestTarget& target, int iterations,
              float* seeds, float* remainder) {
  if (!chain.is_simple) return approach_of<0, true, T>(chain, target, iterations, seeds, remainder);
  switch (chain.n) {
    case 6:
      return approach_of<6, false, T>(chain, target, iterations, seeds, remainder);
    case 7:
      return approach_of<7, false, T>(chain, target, iterations, seeds, remainder);
    default:
      return approach_of<0, false, T>(chain, target, iterations, seeds, remainder);
  }
}

}  // namespace iksel::lanes
