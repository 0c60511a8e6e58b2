// SPDX-License-Identifier: BSD-3-Clause
// What a lane has to reach: the error of a frame, and the rows of its Jacobian.
#pragma once

#include "base/symmetric.hpp"
#include "simd/lane_frames.hpp"
#include "simd/lane_math.hpp"
#include "simd/lane_types.hpp"

namespace iksel::lanes {

/// All of a pose. The error is the position's, and 2 sin(angle / 2) * axis of R_target R^T, which
/// grows up to half a turn.
template <typename T, typename Pack = LanePack>
class FullPose {
 public:
  FullPose(const Pack& pack, const LaneTask* /*task*/) : pack_(pack) {}

  IKSEL_INLINE void measure(const LaneFrame<T>& f, T (&e)[6]) {
    for (int i = 0; i < 3; ++i) e[i] = row(i) - f.p[i];
    T trace = T(1.0);
    for (int i = 0; i < 3; ++i) {
      trace = trace + f.x[i] * row(3 + i) + f.y[i] * row(6 + i) + f.z[i] * row(9 + i);
    }
    // Above what rounding leaves of it at half a turn.
    const T least(sizeof(NumberOf<T>) == 4 ? 1e-6 : 1e-12);
    const T factor = T(1.0) / sqrt(max(trace, least));
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3;
      const int b = (i + 2) % 3;
      const T twist = f.x[a] * row(3 + b) - f.x[b] * row(3 + a) + f.y[a] * row(6 + b) -
                      f.y[b] * row(6 + a) + f.z[a] * row(9 + b) - f.z[b] * row(9 + a);
      e[3 + i] = twist * factor;
    }
  }
  /// The point whose velocity the columns are made for.
  IKSEL_INLINE const T* point(const LaneFrame<T>& f) const { return f.p; }
  IKSEL_INLINE void to_rows(T (&/*column*/)[6]) const {}
  /// y of (A + lambda I) y = e; A is no more needed.
  IKSEL_INLINE void solve(T (&A)[6][6], const T& lambda, const T (&e)[6], T (&y)[6]) const {
    SymmetricFactors<T>(A, lambda).solve(e, y);
  }

 private:
  IKSEL_INLINE T row(int r) const { return row_of(pack_.target[r]); }
  static IKSEL_INLINE T row_of(const NumberOf<T> (&lanes)[kWidth]) { return Lanes<T>::load(lanes); }
  template <typename All>
  static IKSEL_INLINE T row_of(const All& all) {
    return T(all);
  }

  const Pack& pack_;
};

/// A task: the deviation along its axes, as goal/task_space.hpp defines it, and what is missing of
/// it to the bounds.
template <typename T>
class TaskGoal {
 public:
  TaskGoal(const LanePack& pack, const LaneTask* task) : pack_(pack), task_(*task) {}

  void measure(const LaneFrame<T>& f, T (&e)[6]) {
    const T* axes[3] = {f.x, f.y, f.z};
    T away[3];
    for (int i = 0; i < 3; ++i) {
      point_[i] = f.p[i];
      for (int k = 0; k < 3; ++k) point_[i] = point_[i] + axes[k][i] * T(task_.tcp[k]);
      away[i] = point_[i] - row(i);
    }
    to_axes(away, d_);
    // E = W^T R K, column by column.
    T E[3][3];
    for (int c = 0; c < 3; ++c) {
      T turned[3];
      for (int i = 0; i < 3; ++i) {
        turned[i] = f.x[i] * row(12 + 3 * c) + f.y[i] * row(13 + 3 * c) + f.z[i] * row(14 + 3 * c);
      }
      to_axes(turned, E[c]);
    }
    if (task_.open[3] && task_.open[4] && task_.open[5]) {
      for (int i = 3; i < 6; ++i) d_[i] = T(0.0);
    } else if (task_.twist < 0) {
      measure_vector(E);
    } else {
      measure_swing_and_twist(E);
    }
    for (int i = 0; i < 6; ++i) {
      e[i] = task_.open[i] ? T(0.0) : min(max(d_[i], T(task_.lower[i])), T(task_.upper[i])) - d_[i];
    }
  }

  const T* point(const LaneFrame<T>& /*f*/) const { return point_; }

  void to_rows(T (&column)[6]) const {
    T linear[3];
    T w[3];
    to_axes(column, linear);
    to_axes(column + 3, w);
    for (int i = 0; i < 3; ++i) column[i] = linear[i];
    if (task_.twist < 0) {
      // w' = w - v x w / 2 + k v x (v x w): the inverse of the left Jacobian at the rotation
      // vector v.
      const T* v = d_ + 3;
      const T once[3] = {cross_at(0, v, w), cross_at(1, v, w), cross_at(2, v, w)};
      for (int i = 0; i < 3; ++i) {
        column[3 + i] = w[i] - T(0.5) * once[i] + k_ * cross_at(i, v, once);
      }
      return;
    }
    const int a = task_.twist;
    const int b = (a + 1) % 3;
    const int c = (a + 2) % 3;
    const T along_n = n_[0] * w[b] + n_[1] * w[c];
    const T along_m = n_[1] * w[b] - n_[0] * w[c];
    const T swing = cotangent_ * along_m - phi_ * w[a];
    column[3 + b] = n_[0] * along_n + n_[1] * swing;
    column[3 + c] = n_[1] * along_n - n_[0] * swing;
    column[3 + a] = w[a] + half_ * along_m;
  }

  /// Parts inside their bounds ask for nothing, unless the step would take them out: then they are
  /// to stay at the bound.
  void solve(T (&A)[6][6], const T& lambda, const T (&e)[6], T (&y)[6]) const {
    T asked[6];
    T active[6];
    for (int i = 0; i < 6; ++i) {
      asked[i] = e[i];
      active[i] = task_.fixed[i]  ? T(1.0)
                  : task_.open[i] ? T(0.0)
                                  : select(abs(e[i]) > T(0.0), T(1.0), T(0.0));
    }
    for (int round = 1;; ++round) {
      T masked[6][6];
      for (int i = 0; i < 6; ++i) {
        for (int k = 0; k <= i; ++k) masked[i][k] = A[i][k] * active[i] * active[k];
      }
      SymmetricFactors<T>(masked, lambda).solve(asked, y);
      if (round == 4 || !activate(A, y, asked, active)) return;
    }
  }

 private:
  IKSEL_INLINE T row(int r) const { return Lanes<T>::load(pack_.target[r]); }
  /// W^T v
  void to_axes(const T* v, T* out) const {
    for (int i = 0; i < 3; ++i) {
      out[i] = row(3 + 3 * i) * v[0] + row(4 + 3 * i) * v[1] + row(5 + 3 * i) * v[2];
    }
  }

  /// The rotation vector.
  void measure_vector(const T (&E)[3][3]) {
    const T scale = T(1.0) / sqrt(max(E[0][0] + E[1][1] + E[2][2] + T(1.0), T(1e-12)));
    T s2 = T(0.0);
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3;
      const int b = (i + 2) % 3;
      d_[3 + i] = (E[a][b] - E[b][a]) * scale;
      s2 = s2 + d_[3 + i] * d_[3 + i];
    }
    // So far of length 2 sin(angle / 2).
    const T s = min(T(0.5) * sqrt(s2), T(1.0));
    const T factor = asin_over(s);
    for (int i = 3; i < 6; ++i) d_[i] = d_[i] * factor;
    const T half = s * factor;
    const T square = max(T(4.0) * half * half, T(1e-30));
    const T cosine = sqrt(max(T(1.0) - s * s, T(0.0)));
    // (1 - half cot(half)) / angle^2 -> 1/12
    const T exact = (T(1.0) - half * cosine / max(s, T(1e-30))) / square;
    k_ = select(half < T(1e-4), T(1.0 / 12), exact);
  }

  /// The swing of the axis, and the twist about it.
  void measure_swing_and_twist(const T (&E)[3][3]) {
    const int a = task_.twist;
    const int b = (a + 1) % 3;
    const int c = (a + 2) % 3;
    // Where the axis points, u = E a; n sin(phi) = a x u.
    const T& cosine = E[a][a];
    const T sine = sqrt(E[a][b] * E[a][b] + E[a][c] * E[a][c]);
    const auto turns = sine > T(1e-12);
    const T inverse = T(1.0) / max(sine, T(1e-12));
    n_[0] = select(turns, (T(0.0) - E[a][c]) * inverse, T(1.0));
    n_[1] = select(turns, E[a][b] * inverse, T(0.0));
    const T up = max(T(1.0) + cosine, T(1e-9));
    half_ = sine / up;
    // sin(phi / 2) from tan(phi / 2).
    const T s = min(half_ / sqrt(T(1.0) + half_ * half_), T(1.0));
    phi_ = T(2.0) * s * asin_over(s);
    cotangent_ =
        select(sine > T(1e-9), phi_ * cosine * inverse, select(cosine > T(0.0), T(1.0), T(0.0)));
    d_[3 + b] = n_[0] * phi_;
    d_[3 + c] = n_[1] * phi_;
    // tan(twist / 2) = (E_cb - E_bc) / (1 + trace)
    const T odd = E[b][c] - E[c][b];
    const T even = T(1.0) + E[0][0] + E[1][1] + E[2][2];
    const T t = abs(odd) / sqrt(max(odd * odd + even * even, T(1e-30)));
    const T twist = T(2.0) * t * asin_over(min(t, T(1.0)));
    d_[3 + a] = select(odd < T(0.0), T(0.0) - twist, twist);
  }

  /// Makes parts active that the step J^T y, J J^T = A, would take out of their bounds; false if
  /// there are none.
  bool activate(const T (&A)[6][6], const T (&y)[6], T (&asked)[6], T (&active)[6]) const {
    bool found = false;
    for (int i = 0; i < 6; ++i) {
      if (task_.fixed[i] || task_.open[i]) continue;
      T goal = d_[i];
      for (int k = 0; k < 6; ++k) goal = goal + (k <= i ? A[i][k] : A[k][i]) * y[k];
      const T bound = min(max(goal, T(task_.lower[i])), T(task_.upper[i]));
      const auto leaves = (active[i] < T(0.5)) & (abs(bound - goal) > T(0.0));
      if (!any(leaves)) continue;
      found = true;
      active[i] = select(leaves, T(1.0), active[i]);
      asked[i] = select(leaves, bound - d_[i], asked[i]);
    }
    return found;
  }

  const LanePack& pack_;
  const LaneTask& task_;
  T point_[3];
  T d_[6];
  // What the rows of the rotation are made of: for the vector, or for swing and twist.
  T k_ = T(0.0);
  T n_[2] = {T(0.0), T(0.0)};
  T phi_ = T(0.0);
  T cotangent_ = T(0.0);
  T half_ = T(0.0);
};

}  // namespace iksel::lanes
