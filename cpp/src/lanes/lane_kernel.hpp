// SPDX-License-Identifier: BSD-3-Clause
// Levenberg-Marquardt over a pack of lanes, each with its own target, with the limits inside the
// step.
#pragma once

#include "lanes/lane_math.hpp"
#include "lanes/lane_types.hpp"
#include "lanes/seed_kernel.hpp"
#include "math/symmetric.hpp"

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

/// kN joints, or chain.n where kN is 0.
template <typename T, int kN>
PackResult advance(const LaneChain& chain, const LaneOptions& options, unsigned watched,
                   int iterations, LanePack& pack) {
  constexpr int kSize = kN > 0 ? kN : kMaxJoints;
  const int n = kN > 0 ? kN : chain.n;
  using L = Lanes<T>;
  const auto target = [&](int row) { return L::load(pack.target[row]); };

  T q[kSize];
  for (int j = 0; j < n; ++j) q[j] = L::load(pack.q[j]);

  for (int iteration = 1;; ++iteration) {
    // Frames of the joints: axis and origin of each, and the pose of the last.
    T x[3];
    T y[3];
    T z[3];
    T p[3];
    T axis[kSize][3];
    T origin[kSize][3];
    for (int i = 0; i < 3; ++i) {
      x[i] = T(i == 0 ? 1.0 : 0.0);
      y[i] = T(i == 1 ? 1.0 : 0.0);
      z[i] = T(i == 2 ? 1.0 : 0.0);
      p[i] = T(0.0);
    }
#pragma GCC unroll 10
    for (int j = 0; j < n; ++j) {
      const LaneJoint& joint = chain.joint[j];
      if (j > 0) {
        for (int i = 0; i < 3; ++i) {
          p[i] = p[i] + x[i] * T(joint.p[0]) + y[i] * T(joint.p[1]) + z[i] * T(joint.p[2]);
        }
        turn(y, z, T(joint.cos_alpha), T(joint.sin_alpha));
      }
      for (int i = 0; i < 3; ++i) axis[j][i] = z[i];
      if (joint.prismatic) {
        turn(x, y, T(joint.cos_turn), T(joint.sin_turn));
        const T slide = q[j] + T(joint.offset);
        for (int i = 0; i < 3; ++i) p[i] = p[i] + z[i] * slide;
      } else {
        T sine;
        T cosine;
        sincos(q[j] + T(joint.offset), sine, cosine);
        if (j == 0) {
          x[0] = cosine;
          x[1] = sine;
          y[0] = T(0.0) - sine;
          y[1] = cosine;
        } else {
          turn(x, y, cosine, sine);
        }
      }
      for (int i = 0; i < 3; ++i) origin[j][i] = p[i];
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

    // A = J J^T over the joints that may move, then dq = J^T (A + lambda I)^-1 e.
    T J[kSize][6];
    T A[6][6];
#pragma GCC unroll 6
    for (int r = 0; r < 6; ++r) {
#pragma GCC unroll 6
      for (int c = 0; c <= r; ++c) A[r][c] = T(0.0);
    }
#pragma GCC unroll 10
    for (int j = 0; j < n; ++j) {
      const LaneJoint& joint = chain.joint[j];
      T* column = J[j];
      if (joint.prismatic) {
        for (int i = 0; i < 3; ++i) {
          column[i] = axis[j][i];
          column[3 + i] = T(0.0);
        }
      } else {
        const T r[3] = {p[0] - origin[j][0], p[1] - origin[j][1], p[2] - origin[j][2]};
        for (int i = 0; i < 3; ++i) {
          const int a = (i + 1) % 3;
          const int b = (i + 2) % 3;
          column[i] = axis[j][a] * r[b] - axis[j][b] * r[a];
          column[3 + i] = axis[j][i];
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
#pragma GCC unroll 6
      for (int r = 0; r < 6; ++r) {
#pragma GCC unroll 6
        for (int c = 0; c <= r; ++c) A[r][c] = A[r][c] + column[r] * column[c];
      }
    }
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
  return {name,
          Lanes<T>::kCount,
          {advance<T, 0>, advance<T, 1>, advance<T, 2>, advance<T, 3>, advance<T, 4>, advance<T, 5>,
           advance<T, 6>, advance<T, 7>, advance<T, 8>, advance<T, 9>, advance<T, 10>},
          prepare_seeds<S>,
          keep_from<S>,
          find_largest<S>};
}

}  // namespace iksel::lanes
