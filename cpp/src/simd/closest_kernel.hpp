// SPDX-License-Identifier: BSD-3-Clause
// Seeds moved towards where the least is missing of a pose that may have no answer: Newton's method
// on
//   C = 1/2 w_p^2 |p - t|^2 + 1/2 w_r^2 (3 - trace M),  M = sum over columns k of r_k t_k^T,
// where 3 - trace M is the square of 2 sin(angle / 2); damped as Levenberg-Marquardt, with the
// limits as an active set. For joints i <= j with axes z, velocities L of the point, d = p - t and
// v = sum of r_k x t_k:
//   C_j = w_p^2 d . L_j - 1/2 w_r^2 z_j . v
//   C_ij = w_p^2 (L_i . L_j + L_j . (d x z_i)) + 1/2 w_r^2 (z_i . z_j trace M - z_i . M z_j).
#pragma once

#include "simd/coupled_kernel.hpp"
#include "simd/lane_frames.hpp"
#include "simd/lane_math.hpp"
#include "simd/lane_types.hpp"

namespace iksel::lanes {

template <typename T>
IKSEL_INLINE T dot3(const T* a, const T* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename T>
IKSEL_INLINE void cross3(const T* a, const T* b, T* out) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/// What is missing at a frame.
template <typename T>
struct Remaining {
  T d[3];     ///< p - t
  T v[3];     ///< sum of r_k x t_k
  T M[3][3];  ///< sum of r_k t_k^T
  T trace;
  T value;  ///< C
};

template <typename T>
IKSEL_INLINE void measure_remaining(const LaneFrame<T>& f, const float* target, float position2,
                                    float rotation2, Remaining<T>& out) {
  const T* columns[3] = {f.x, f.y, f.z};
  for (int i = 0; i < 3; ++i) out.d[i] = f.p[i] - T(target[i]);
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      out.M[a][b] = columns[0][a] * T(target[3 + b]) + columns[1][a] * T(target[6 + b]) +
                    columns[2][a] * T(target[9 + b]);
    }
  }
  out.trace = out.M[0][0] + out.M[1][1] + out.M[2][2];
  for (int i = 0; i < 3; ++i) {
    const int a = (i + 1) % 3;
    const int b = (i + 2) % 3;
    out.v[i] = out.M[a][b] - out.M[b][a];
  }
  out.value =
      T(0.5F * position2) * dot3(out.d, out.d) + T(0.5F * rotation2) * (T(3.0F) - out.trace);
}

/// The step of Newton's method from q, at most `longest` in each joint. `J` has the joints' origins
/// and axes, and is made into columns.
template <typename T>
IKSEL_INLINE void step_to_closest(const LaneChainOf<float>& chain, const LaneFrame<T>& frame,
                                  const Remaining<T>& at, float position2, float rotation2,
                                  const T& damping, const T* q, T (*J)[6], T* step) {
  constexpr float kLongest = 0.5F;
  const int n = chain.n;
  T H[kMaxJoints][kMaxJoints];
  T moved[kMaxJoints][3];   // L_i + d x z_i
  T turned[kMaxJoints][3];  // trace M z_i - M^T z_i
  T free[kMaxJoints];
  T scale[kMaxJoints];
  for (int j = 0; j < n; ++j) {
    const auto& joint = chain.joint[j];
    T* L = J[j];
    T* z = J[j] + 3;
    T slope;
    if (joint.prismatic) {
      for (int i = 0; i < 3; ++i) {
        L[i] = z[i];
        z[i] = T(0.0F);
      }
      slope = T(position2) * dot3(at.d, L);
    } else {
      const T r[3] = {frame.p[0] - L[0], frame.p[1] - L[1], frame.p[2] - L[2]};
      cross3(z, r, L);
      slope = T(position2) * dot3(at.d, L) - T(0.5F * rotation2) * dot3(z, at.v);
    }
    scale[j] = T(position2) * dot3(L, L) + T(rotation2) * dot3(z, z);
    free[j] = T(1.0F);
    if (joint.limited) {
      const auto leaves = ((q[j] <= T(joint.lower)) & (slope > T(0.0F))) |
                          ((q[j] >= T(joint.upper)) & (slope < T(0.0F)));
      free[j] = select(leaves, T(0.0F), T(1.0F));
    }
    step[j] = T(0.0F) - slope * free[j];
    cross3(at.d, z, moved[j]);
    for (int a = 0; a < 3; ++a) {
      moved[j][a] = moved[j][a] + L[a];
      turned[j][a] = at.trace * z[a] - (at.M[0][a] * z[0] + at.M[1][a] * z[1] + at.M[2][a] * z[2]);
    }
    for (int i = 0; i <= j; ++i) {
      const T second = T(position2) * dot3(L, moved[i]) + T(0.5F * rotation2) * dot3(z, turned[i]);
      H[j][i] = second * free[i] * free[j];
    }
    H[j][j] = H[j][j] + (T(1.0F) - free[j]) + damping * scale[j] + T(1e-9F);
  }
  // L D L^T; pivots that are not positive are turned round, so that the step descends.
  T inverse[kMaxJoints];
  for (int j = 0; j < n; ++j) {
    T d = H[j][j];
    T scaled[kMaxJoints];
    for (int k = 0; k < j; ++k) {
      scaled[k] = H[j][k];
      H[j][k] = H[j][k] * inverse[k];
      d = d - H[j][k] * scaled[k];
    }
    inverse[j] = T(1.0F) / max(abs(d), T(1e-3F) * scale[j] + T(1e-9F));
    for (int i = j + 1; i < n; ++i) {
      for (int k = 0; k < j; ++k) H[i][j] = H[i][j] - H[i][k] * H[j][k];
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) step[i] = step[i] - H[i][k] * step[k];
  }
  T longest = T(kLongest);
  for (int i = n - 1; i >= 0; --i) {
    step[i] = step[i] * inverse[i];
    for (int k = i + 1; k < n; ++k) step[i] = step[i] - H[k][i] * step[k];
    longest = max(longest, abs(step[i]));
  }
  const T part = T(kLongest) / longest;
  for (int j = 0; j < n; ++j) step[j] = step[j] * part;
}

/// Iterates all lanes of a pack so often. Of the pack, `error2` becomes 2 C, and q where that is.
template <typename T>
void approach(const LaneChainOf<float>& chain, float position, float rotation, int iterations,
              RoughPack& pack) {
  const int n = chain.n;
  const float position2 = position * position;
  const float rotation2 = rotation * rotation;
  for (int first = 0; first < kBlock; first += Lanes<T>::kCount) {
    T q[kMaxJoints];
    T best_q[kMaxJoints];
    for (int j = 0; j < n; ++j) best_q[j] = q[j] = Lanes<T>::load(pack.q[j] + first);
    T best = T(1e30F);
    T damping = T(1e-2F);
    for (int iteration = 0;; ++iteration) {
      T J[kMaxJoints][6];
      LaneFrame<T> frame;
      place_joints(chain, q, J, frame);
      Remaining<T> at;
      measure_remaining(frame, pack.target, position2, rotation2, at);
      // A lane that got worse goes back, and tries again from there with a shorter step.
      const auto better = at.value <= best;
      best = select(better, at.value, best);
      for (int j = 0; j < n; ++j) best_q[j] = select(better, q[j], best_q[j]);
      if (iteration == iterations) break;
      T step[kMaxJoints];
      step_to_closest(chain, frame, at, position2, rotation2, damping, q, J, step);
      damping = select(better, max(damping * T(0.2F), T(1e-6F)), min(damping * T(16.0F), T(1e3F)));
      for (int j = 0; j < n; ++j) {
        const auto& joint = chain.joint[j];
        q[j] = select(better, q[j] + step[j], best_q[j]);
        if (joint.limited) q[j] = min(max(q[j], T(joint.lower)), T(joint.upper));
      }
      if (chain.coupled_rows > 0) hold_coupled(chain, q);
    }
    for (int j = 0; j < n; ++j) Lanes<T>::store(best_q[j], pack.q[j] + first);
    Lanes<T>::store(best + best, pack.error2 + first);
  }
}

}  // namespace iksel::lanes
