// SPDX-License-Identifier: BSD-3-Clause
// Levenberg-Marquardt over a pack of lanes, each with its own target, with the limits inside the
// step.
#pragma once

#include "base/symmetric.hpp"
#include "simd/lane_math.hpp"
#include "simd/lane_types.hpp"
#include "simd/seed_kernel.hpp"

namespace iksel::lanes {

/// (u, v) <- (c u + s v, c v - s u)
template <typename T, typename C>
inline void turn(T (&u)[3], T (&v)[3], const C& c, const C& s) {
  for (int i = 0; i < 3; ++i) {
    const T a = u[i];
    u[i] = a * c + v[i] * s;
    v[i] = v[i] * c - a * s;
  }
}

/// Rows kFirst to kLast - 1 of the lower half of A = J J^T: few at a time stay in registers.
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

/// One for any number of joints: made for a known number it was no faster on AVX-512, AVX2 or SSE2.
template <typename T>
PackResult advance(const LaneChain& chain, const LaneOptions& options, unsigned watched,
                   int iterations, LanePack& pack) {
  const int n = chain.n;
  using L = Lanes<T>;
  const auto target = [&](int row) { return L::load(pack.target[row]); };

  T q[kMaxJoints];
  for (int j = 0; j < n; ++j) q[j] = L::load(pack.q[j]);

  for (int iteration = 1;; ++iteration) {
    // Columns of the Jacobian, which hold the origin and the axis of their joint at first; and the
    // pose of the last frame.
    T J[kMaxJoints][6];
    T x[3];
    T y[3];
    T z[3];
    T p[3];
    for (int i = 0; i < 3; ++i) {
      x[i] = T(i == 0 ? 1.0 : 0.0);
      y[i] = T(i == 1 ? 1.0 : 0.0);
      z[i] = T(i == 2 ? 1.0 : 0.0);
      p[i] = T(0.0);
    }
    // The joints' sines first: they do not depend on each other, and the frames need the registers.
    T sine[kMaxJoints];
    T cosine[kMaxJoints];
    for (int j = 0; j < n; ++j) sincos(q[j] + T(chain.joint[j].offset), sine[j], cosine[j]);
#pragma GCC unroll 10
    for (int j = 0; j < n; ++j) {
      const LaneJoint& joint = chain.joint[j];
      if (j > 0) {
        for (int i = 0; i < 3; ++i) {
          p[i] = p[i] + x[i] * T(joint.p[0]) + y[i] * T(joint.p[1]) + z[i] * T(joint.p[2]);
        }
        turn(y, z, T(joint.cos_alpha), T(joint.sin_alpha));
      }
      for (int i = 0; i < 3; ++i) J[j][3 + i] = z[i];
      if (joint.prismatic) {
        turn(x, y, T(joint.cos_turn), T(joint.sin_turn));
        const T slide = q[j] + T(joint.offset);
        for (int i = 0; i < 3; ++i) p[i] = p[i] + z[i] * slide;
      } else if (j == 0) {
        x[0] = cosine[0];
        x[1] = sine[0];
        y[0] = T(0.0) - sine[0];
        y[1] = cosine[0];
      } else {
        turn(x, y, cosine[j], sine[j]);
      }
      for (int i = 0; i < 3; ++i) J[j][i] = p[i];
    }

    // Error: position, and 2 sin(angle / 2) * axis of R_target R^T, which grows up to half a turn.
    T e[6];
    for (int i = 0; i < 3; ++i) e[i] = target(i) - p[i];
    T trace = T(1.0);
    for (int i = 0; i < 3; ++i) {
      trace = trace + x[i] * target(3 + i) + y[i] * target(6 + i) + z[i] * target(9 + i);
    }
    const T factor = T(1.0) / sqrt(max(trace, T(1e-12)));
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3;
      const int b = (i + 2) % 3;
      const T twist = x[a] * target(3 + b) - x[b] * target(3 + a) + y[a] * target(6 + b) -
                      y[b] * target(6 + a) + z[a] * target(9 + b) - z[b] * target(9 + a);
      e[3 + i] = twist * factor;
    }
    const T ep2 = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
    const T er2 = e[3] * e[3] + e[4] * e[4] + e[5] * e[5];
    const T e2 = ep2 + er2;

    // Joints that stand at a limit and would leave it do not move.
#pragma GCC unroll 10
    for (int j = 0; j < n; ++j) {
      const LaneJoint& joint = chain.joint[j];
      T* column = J[j];
      const T* axis = column + 3;
      if (joint.prismatic) {
        for (int i = 0; i < 3; ++i) {
          column[i] = axis[i];
          column[3 + i] = T(0.0);
        }
      } else {
        const T r[3] = {p[0] - column[0], p[1] - column[1], p[2] - column[2]};
        for (int i = 0; i < 3; ++i) {
          const int a = (i + 1) % 3;
          const int b = (i + 2) % 3;
          column[i] = axis[a] * r[b] - axis[b] * r[a];
        }
      }
      if (joint.limited) {
        const auto low = q[j] <= T(joint.lower);
        const auto high = q[j] >= T(joint.upper);
        if (any(low | high)) {
          T gradient = column[0] * e[0];
          for (int i = 1; i < 6; ++i) gradient = gradient + column[i] * e[i];
          const auto leaves = (low & (gradient < T(0.0))) | (high & (gradient > T(0.0)));
          for (int i = 0; i < 6; ++i) column[i] = select(leaves, T(0.0), column[i]);
        }
      }
    }
    // dq = J^T (J J^T + lambda I)^-1 e.
    T A[6][6];
    multiply_rows<0, 3>(n, J, A);
    multiply_rows<3, 5>(n, J, A);
    multiply_rows<5, 6>(n, J, A);
    const T lambda = T(options.damping) * e2 + T(1e-18);
    T step[6];
    SymmetricFactors<T>(A, lambda).solve(e, step);
    // A lane that is there already stays: along a singular direction the step may be long.
    const auto there =
        (ep2 + er2 * T(options.lever2) <= T(options.position2)) & (er2 <= T(options.rotation2));
    for (T& part : step) part = select(there, T(0.0), part);
    T dq2 = T(0.0);
#pragma GCC unroll 10
    for (int j = 0; j < n; ++j) {
      T dq = J[j][0] * step[0];
#pragma GCC unroll 6
      for (int i = 1; i < 6; ++i) dq = dq + J[j][i] * step[i];
      dq2 = dq2 + dq * dq;
      q[j] = q[j] + dq;
      const LaneJoint& joint = chain.joint[j];
      if (joint.limited) q[j] = min(max(q[j], T(joint.lower)), T(joint.upper));
    }

    // Steps shrink quadratically: after a short one the error needs no look.
    const auto done = (dq2 <= T(options.last_step2)) & (e2 <= T(options.last_error2));
    unsigned mask = 0;
    if (any(done)) {
      double hit[L::kCount];
      L::store(select(done, T(1.0), T(0.0)), hit);
      for (int lane = 0; lane < L::kCount; ++lane) {
        if (hit[lane] != 0.0) mask |= 1U << static_cast<unsigned>(lane);
      }
      mask &= watched;
    }
    if (mask != 0 || iteration >= iterations) {
      for (int j = 0; j < n; ++j) L::store(q[j], pack.q[j]);
      L::store(e2, pack.error2);
      return {mask, iteration};
    }
  }
}

template <typename T, typename S>
constexpr LaneKernels make_kernels(const char* name) {
  return {name, Lanes<T>::kCount, advance<T>, prepare_seeds<S>, add_known<S>, find_largest<S>};
}

}  // namespace iksel::lanes
