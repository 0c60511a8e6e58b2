// SPDX-License-Identifier: BSD-3-Clause
// Levenberg-Marquardt over a pack of seeds, one per lane, with the limits inside the step.
#pragma once

#include "lanes/lane_math.hpp"
#include "lanes/lane_types.hpp"

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

/// Solves (A + lambda I) y = b for a symmetric 6 x 6 A of which the lower half is given (L D L^T).
template <typename T>
inline void solve_symmetric(T (&A)[6][6], const T& lambda, const T (&b)[6], T (&y)[6]) {
  T inverse[6];
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    T d = A[j][j] + lambda;
    T scaled[6];
#pragma GCC unroll 6
    for (int k = 0; k < j; ++k) {
      scaled[k] = A[j][k];
      A[j][k] = A[j][k] * inverse[k];
      d = d - A[j][k] * scaled[k];
    }
    inverse[j] = T(1.0) / d;
#pragma GCC unroll 6
    for (int i = j + 1; i < 6; ++i) {
      T v = A[i][j];
#pragma GCC unroll 6
      for (int k = 0; k < j; ++k) v = v - A[i][k] * A[j][k];
      A[i][j] = v;
    }
  }
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) {
    T v = b[i];
#pragma GCC unroll 6
    for (int k = 0; k < i; ++k) v = v - A[i][k] * y[k];
    y[i] = v;
  }
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) y[i] = y[i] * inverse[i];
#pragma GCC unroll 6
  for (int i = 5; i >= 0; --i) {
#pragma GCC unroll 6
    for (int k = i + 1; k < 6; ++k) y[i] = y[i] - A[k][i] * y[k];
  }
}

/// kN joints, or chain.n where kN is 0.
template <typename T, int kN>
PackResult solve_pack(const LaneChain& chain, const LaneTarget& target, const LaneOptions& options,
                      const double* seeds, double* q_out) {
  constexpr int kSize = kN > 0 ? kN : kMaxJoints;
  const int n = kN > 0 ? kN : chain.n;
  using L = Lanes<T>;

  T q[kSize];
  for (int j = 0; j < n; ++j) q[j] = L::load(seeds + j * kGroup);

  const double position2 = 0.5 * options.position_tolerance * options.position_tolerance;
  const double rotation2 = 0.998 * options.rotation_tolerance * options.rotation_tolerance;
  const double lever2 = chain.lever * chain.lever;

  for (int iteration = 0;; ++iteration) {
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
    for (int i = 0; i < 3; ++i) e[i] = T(target.p[i]) - p[i];
    T twist[3];
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3;
      const int b = (i + 2) % 3;
      twist[i] = x[a] * T(target.x[b]) - x[b] * T(target.x[a]) + y[a] * T(target.y[b]) -
                 y[b] * T(target.y[a]) + z[a] * T(target.z[b]) - z[b] * T(target.z[a]);
    }
    T trace = T(1.0);
    for (int i = 0; i < 3; ++i) {
      trace = trace + x[i] * T(target.x[i]) + y[i] * T(target.y[i]) + z[i] * T(target.z[i]);
    }
    const T factor = T(1.0) / sqrt(max(trace, T(1e-12)));
    for (int i = 0; i < 3; ++i) e[3 + i] = twist[i] * factor;

    const T ep2 = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
    const T er2 = e[3] * e[3] + e[4] * e[4] + e[5] * e[5];
    // |error at the TCP| <= |position error| + lever * |rotation error|.
    const auto converged = (ep2 + er2 * T(lever2) <= T(position2)) & (er2 <= T(rotation2));
    if (any(converged)) {
      double hit[L::kCount];
      L::store(select(converged, T(1.0), T(0.0)), hit);
      int lane = 0;
      while (hit[lane] == 0.0) ++lane;
      double values[L::kCount];
      for (int j = 0; j < n; ++j) {
        L::store(q[j], values);
        q_out[j] = values[lane];
      }
      return {lane, iteration};
    }
    if (iteration == options.max_iterations) return {-1, iteration};

    // A = J J^T over the joints that may move, then dq = J^T (A + lambda I)^-1 e.
    T J[kSize][6];
    T A[6][6];
    for (int r = 0; r < 6; ++r) {
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
    const T lambda = T(options.damping) * (ep2 + er2) + T(1e-18);
    T step[6];
    solve_symmetric(A, lambda, e, step);
#pragma GCC unroll 10
    for (int j = 0; j < n; ++j) {
      T dq = J[j][0] * step[0];
#pragma GCC unroll 6
      for (int i = 1; i < 6; ++i) dq = dq + J[j][i] * step[i];
      q[j] = q[j] + dq;
      const LaneJoint& joint = chain.joint[j];
      if (joint.limited) q[j] = min(max(q[j], T(joint.lower)), T(joint.upper));
    }
  }
}

/// q brought to the first turn above the lower limit, by whole turns.
template <typename T>
inline T wrap_above(const T& q, double lower) {
  const T turns = floor((q - T(lower)) * T(0.159154943091895335769));
  return q - turns * T(6.28318530717958647692);
}

template <typename T>
unsigned prepare_seeds(const LaneChain& chain, const LaneTarget& target,
                       const LaneReduction& reduction, const double* group, double* seeds) {
  using L = Lanes<T>;
  const int n = chain.n;
  unsigned valid = 0;
  for (int first = 0; first < kGroup; first += L::kCount) {
    const auto row = [&](int r) { return L::load(group + r * kGroup + first); };
    const auto write = [&](int j, const T& value) { L::store(value, seeds + j * kGroup + first); };
    T inside = T(1.0);
    const auto check = [&](int j, const T& value) {
      inside = select(value <= T(chain.joint[j].upper), inside, T(0.0));
      inside = select(value >= T(chain.joint[j].lower), inside, T(0.0));
    };
    for (int j = 0; j < n; ++j) write(j, row(kPoseRows + j));

    // The left side first; c, s is the turn about the first axis that is left to the right side.
    T c = T(1.0);
    T s = T(0.0);
    const int right = n - 1;
    if (reduction.left == Side::rotation) {
      const T w2 = T(reduction.weight2);
      T px = row(0);
      T py = row(1);
      const T zx = row(9);
      const T zy = row(10);
      double tx = target.p[0];
      double ty = target.p[1];
      if (reduction.right == Side::translation) {
        // The slide moves the position, but not the foot of the perpendicular onto its line.
        const T along = px * zx + py * zy + row(2) * row(11);
        px = px - along * zx;
        py = py - along * zy;
        const double target_along = tx * target.z[0] + ty * target.z[1] + target.p[2] * target.z[2];
        tx -= target_along * target.z[0];
        ty -= target_along * target.z[1];
      }
      const T S = px * T(ty) - py * T(tx) + w2 * (zx * T(target.z[1]) - zy * T(target.z[0]));
      const T C = px * T(tx) + py * T(ty) + w2 * (zx * T(target.z[0]) + zy * T(target.z[1]));
      const T scale = T(1.0) / sqrt(max(S * S + C * C, T(1e-300)));
      c = select(C * C + S * S > T(1e-300), C * scale, T(1.0));
      s = S * scale;
      const T q = wrap_above(rough_atan2(S, C) - T(chain.joint[0].offset), chain.joint[0].lower);
      check(0, q);
      write(0, q);
    } else if (reduction.left == Side::translation) {
      const T q = T(target.p[2]) - row(2) - T(chain.joint[0].offset);
      check(0, q);
      write(0, q);
    }
    if (reduction.right == Side::rotation) {
      // Columns x and y of the target, turned back by the first joint.
      const T ax = c * T(target.x[0]) + s * T(target.x[1]);
      const T ay = c * T(target.x[1]) - s * T(target.x[0]);
      const T bx = c * T(target.y[0]) + s * T(target.y[1]);
      const T by = c * T(target.y[1]) - s * T(target.y[0]);
      const T m00 = row(3) * ax + row(4) * ay + row(5) * T(target.x[2]);
      const T m10 = row(6) * ax + row(7) * ay + row(8) * T(target.x[2]);
      const T m01 = row(3) * bx + row(4) * by + row(5) * T(target.y[2]);
      const T m11 = row(6) * bx + row(7) * by + row(8) * T(target.y[2]);
      const T q = wrap_above(rough_atan2(m10 - m01, m00 + m11) - T(chain.joint[right].offset),
                             chain.joint[right].lower);
      check(right, q);
      write(right, q);
    } else if (reduction.right == Side::translation) {
      // Along the last axis, which the target gives.
      const T tx = c * T(target.p[0]) + s * T(target.p[1]);
      const T ty = c * T(target.p[1]) - s * T(target.p[0]);
      const T zx = c * T(target.z[0]) + s * T(target.z[1]);
      const T zy = c * T(target.z[1]) - s * T(target.z[0]);
      const T q = (tx - row(0)) * zx + (ty - row(1)) * zy +
                  (T(target.p[2]) - row(2)) * T(target.z[2]) - T(chain.joint[right].offset);
      check(right, q);
      write(right, q);
    }
    double ok[L::kCount];
    L::store(inside, ok);
    for (int lane = 0; lane < L::kCount; ++lane) {
      if (ok[lane] != 0.0) valid |= 1U << static_cast<unsigned>(first + lane);
    }
  }
  return valid;
}

template <typename T>
constexpr LaneKernels make_kernels(const char* name) {
  return {name,
          Lanes<T>::kCount,
          {solve_pack<T, 0>, solve_pack<T, 1>, solve_pack<T, 2>, solve_pack<T, 3>, solve_pack<T, 4>,
           solve_pack<T, 5>, solve_pack<T, 6>, solve_pack<T, 7>, solve_pack<T, 8>, solve_pack<T, 9>,
           solve_pack<T, 10>},
          prepare_seeds<T>};
}

}  // namespace iksel::lanes
