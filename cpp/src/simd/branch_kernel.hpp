// SPDX-License-Identifier: BSD-3-Clause
// Six joints in closed form by subproblems of one and two angles (Paden 1986; Elias and Wen:
// "Canonical subproblems for robot inverse kinematics", 2022), a branch or a pose in each lane.
//
// With the axes h_j at zero angles, R_j = R(h_j, q_j) and p_j,j+1 the way between points on the
// axes: R_06 = R_1 ... R_6, and the way from the point on axis 1 to that on axis 6 is
// w = R_1 (p_12 + R_2 (p_23 + R_3 (p_34 + ...))). Where axes meet, their points are one.
#pragma once

#include "simd/branch_types.hpp"
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
/// a + s b
template <typename T>
IKSEL_INLINE Vec<T> add(const Vec<T>& a, const T& s, const Vec<T>& b) {
  return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

/// An angle by its cosine and sine.
template <typename T>
struct Angle {
  T c = T(1.0);
  T s = T(0.0);
};

/// R(k, t) v, or R(k, -t) v.
template <typename T>
IKSEL_INLINE Vec<T> turned(const Vec<T>& k, const Angle<T>& t, const Vec<T>& v) {
  const Vec<T> kv = cross(k, v);
  const T along = (T(1.0) - t.c) * dot(k, v);
  return {t.c * v.x + t.s * kv.x + along * k.x, t.c * v.y + t.s * kv.y + along * k.y,
          t.c * v.z + t.s * kv.z + along * k.z};
}
template <typename T>
IKSEL_INLINE Vec<T> turned_back(const Vec<T>& k, const Angle<T>& t, const Vec<T>& v) {
  return turned(k, Angle<T>{t.c, T(0.0) - t.s}, v);
}

/// The angle in -pi .. pi, to 1e-15. Without a division, of which a kernel has enough: reduced to
/// pi / 8 at most, and by the series of the arc sine.
template <typename T>
IKSEL_INLINE T to_radians(const Angle<T>& t) {
  const T c = abs(t.c);
  const T s = abs(t.s);
  const T low = min(c, s);
  const T high = max(c, s);
  const T x = low * T(0.92387953251128675613) - high * T(0.38268343236508977173);
  const T x2 = x * x;
  T a = T(0.004240907093679363);
  a = a * x2 + T(0.004660143486915096);
  a = a * x2 + T(0.005153309682319905);
  a = a * x2 + T(0.005740037670841924);
  a = a * x2 + T(0.006447210311889649);
  a = a * x2 + T(0.0073125258735988454);
  a = a * x2 + T(0.008390335809616815);
  a = a * x2 + T(0.009761609529194078);
  a = a * x2 + T(0.011551800896139705);
  a = a * x2 + T(0.01396484375);
  a = a * x2 + T(0.017352764423076924);
  a = a * x2 + T(0.022372159090909092);
  a = a * x2 + T(0.030381944444444444);
  a = a * x2 + T(0.044642857142857144);
  a = a * x2 + T(0.075);
  a = a * x2 + T(0.16666666666666666);
  a = a * x2 + T(1.0);
  a = a * x + T(0.39269908169872415481);
  a = select(s > c, T(1.57079632679489661923) - a, a);
  a = select(t.c < T(0.0), T(3.14159265358979323846) - a, a);
  return select(t.s < T(0.0), T(0.0) - a, a);
}

/// How certain the angles found so far are, as BranchPack has it.
template <typename T>
struct Certainty {
  T least = T(1.0);
  T best = T(1.0);
  T worst = T(1.0);
  /// Error of the angles so far: of this numerator and denominator, so as not to divide each time.
  T error;
  T scale = T(1.0);

  /// An angle follows from a quotient by a number of the size `size`.
  IKSEL_INLINE void divide_by(const T& size) {
    error = error * (size + T(1.0));
    scale = scale * max(size, T(1e-12));
  }
  /// The same by the product of two lengths, mostly equal ones.
  IKSEL_INLINE void divide_by_product(const T& product) { divide_by(sqrt(product)); }
  /// An angle follows from the root of `square`, the difference of squares of a number near to
  /// `near` where that is near 0.
  IKSEL_INLINE void take_root(const T& square, const T& near, const T& root) {
    const T scaled = square * scale;
    const T of_square = T(2.0) * error * near;
    least = min(least, square);
    best = min(best, scaled + of_square);
    worst = min(worst, scaled - of_square);
    divide_by(root);
  }
};

/// Whether there are such angles is all that is asked.
template <typename T>
struct Existence {
  T least = T(1.0);

  IKSEL_INLINE void divide_by_product(const T& /*product*/) {}
  IKSEL_INLINE void take_root(const T& square, const T& /*near*/, const T& /*root*/) {
    least = min(least, square);
  }
};

/// One of the two angles with a cos(t) + b sin(t) = rest; where there is none, the nearest.
template <typename T, typename Q>
IKSEL_INLINE Angle<T> solve_angle(const T& a, const T& b, const T& rest, const T& sign,
                                  Q& quality) {
  const T r2 = a * a + b * b;
  const T square = r2 - rest * rest;
  const T root = sqrt(max(square, T(0.0)));
  quality.take_root(square, abs(rest), root);
  const T inverse = T(1.0) / max(r2, T(1e-30));
  const T cosine = rest * inverse;
  const T sine = sign * root * inverse;
  return {a * cosine - b * sine, b * cosine + a * sine};
}

/// One of the two angles with x . R(k, t) y = rest.
template <typename T, typename Q>
IKSEL_INLINE Angle<T> solve_angle(const Turned& turned, const T& rest, const T& sign, Q& quality) {
  const T left = rest - T(turned.c);
  const T square = T(turned.r2) - left * left;
  const T root = sqrt(max(square, T(0.0)));
  quality.take_root(square, abs(left), root);
  const T cosine = left * T(turned.inverse);
  const T sine = sign * root * T(turned.inverse);
  return {T(turned.a) * cosine - T(turned.b) * sine, T(turned.b) * cosine + T(turned.a) * sine};
}

/// The angle with cosine c and sine s times the product of two lengths, mostly equal ones.
template <typename T, typename Q>
IKSEL_INLINE Angle<T> normalized(const T& c, const T& s, Q& quality) {
  const T size2 = c * c + s * s;
  const T size = sqrt(max(size2, T(1e-60)));
  quality.divide_by_product(size);
  const auto none = size2 < T(1e-56);
  const T inverse = T(1.0) / size;
  return {select(none, T(1.0), c * inverse), select(none, T(0.0), s * inverse)};
}

/// The angle about k that takes u to v.
template <typename T, typename Q>
IKSEL_INLINE Angle<T> angle_between(const Vec<T>& k, const Vec<T>& u, const Vec<T>& v, Q& quality) {
  return normalized(dot(u, v) - dot(k, u) * dot(k, v), dot(k, cross(u, v)), quality);
}

/// A vector with z . k1 = along1, z . k2 = along2 and the square length2, one of two, where
/// k1 . k2 = c.
template <typename T, typename Q>
IKSEL_INLINE Vec<T> solve_common(const Vec<T>& k1, const Vec<T>& k2, double c, const T& along1,
                                 const T& along2, const T& length2, const T& sign, Q& quality) {
  const T inverse = T(1.0 / (1.0 - c * c));
  const T alpha = (along1 - T(c) * along2) * inverse;
  const T beta = (along2 - T(c) * along1) * inverse;
  const T square = length2 - alpha * along1 - beta * along2;
  const T root = sqrt(max(square, T(0.0)));
  quality.take_root(square, T(1.0), root);
  const T gamma = sign * root * T(__builtin_sqrt(1.0 / (1.0 - c * c)));
  const Vec<T> plane{alpha * k1.x + beta * k2.x, alpha * k1.y + beta * k2.y,
                     alpha * k1.z + beta * k2.z};
  return add(plane, gamma, cross(k1, k2));
}

/// A pose as BranchPack has it.
template <typename T>
struct BranchTarget {
  Vec<T> X, Y, Z, w;
};

/// The target of the joints behind the held one, at an angle of that.
template <typename T>
IKSEL_INLINE void hold(const ClosedForm& form, const T& angle, BranchTarget<T>& target) {
  Angle<T> t;
  sincos(angle, t.s, t.c);
  const Vec<T> axis = constant<T>(form.held_axis);
  const Vec<T> from = constant<T>(form.held_from);
  target.X = turned_back(axis, t, target.X);
  target.Y = turned_back(axis, t, target.Y);
  target.Z = turned_back(axis, t, target.Z);
  target.w = add(turned_back(axis, t, add(target.w, T(1.0), from)), T(-1.0), from);
}

/// Q is Certainty or Existence.
template <typename T, typename Q>
struct Branch {
  Angle<T> q[6];
  Q quality;
};

/// Joints 1 to 3, which bring the wrist to w.
template <typename T, typename Q>
IKSEL_INLINE void place_wrist(const ClosedForm& form, const BranchTarget<T>& target,
                              const T (&sign)[3], Branch<T, Q>& out) {
  Q& quality = out.quality;
  const Vec<T> h1 = constant<T>(form.h[0]);
  const Vec<T> h2 = constant<T>(form.h[1]);
  const Vec<T> h3 = constant<T>(form.h[2]);
  const Vec<T> p12 = constant<T>(form.p[0]);
  const Vec<T> p23 = constant<T>(form.p[1]);
  const Vec<T> p34 = constant<T>(form.p[2]);
  const Vec<T>& w = target.w;
  const auto elbow_for = [&](const T& distance2) {
    return solve_angle(form.elbow, T(0.5) * (distance2 - T(form.arm2)), sign[1], quality);
  };
  const auto arm_at = [&](const Angle<T>& q3) { return add(p23, T(1.0), turned(h3, q3, p34)); };
  switch (form.closure) {
    case Closure::parallel_23: {
      // h2 . R_1^T w does not depend on joints 2 and 3.
      const T along1 = dot(h1, w);
      const Vec<T> h1w = cross(h1, w);
      out.q[0] = solve_angle(dot(h2, w) - T(form.cross12) * along1, T(0.0) - dot(h2, h1w),
                             T(form.rest) - T(form.cross12) * along1, sign[0], quality);
      const Vec<T> v = add(turned_back(h1, out.q[0], w), T(-1.0), p12);
      out.q[2] = elbow_for(dot(v, v));
      out.q[1] = angle_between(h2, arm_at(out.q[2]), v, quality);
      return;
    }
    case Closure::intersect_12: {
      const T distance2 = dot(w, w);
      out.q[2] = elbow_for(distance2);
      const Vec<T> arm = arm_at(out.q[2]);
      const Vec<T> v =
          solve_common(h1, h2, form.cross12, dot(h1, w), dot(h2, arm), distance2, sign[0], quality);
      out.q[1] = angle_between(h2, arm, v, quality);
      out.q[0] = angle_between(h1, v, w, quality);
      return;
    }
    case Closure::intersect_23: {
      // |R_1^T w - p12| does not depend on joints 2 and 3.
      const T along1 = dot(h1, w);
      const Vec<T> h1w = cross(h1, w);
      const T axial = dot(h1, p12);
      out.q[0] =
          solve_angle(dot(p12, w) - axial * along1, T(0.0) - dot(p12, h1w),
                      T(0.5) * (dot(w, w) - T(form.rest)) - axial * along1, sign[0], quality);
      const Vec<T> v = add(turned_back(h1, out.q[0], w), T(-1.0), p12);
      const Vec<T> u =
          solve_common(h2, h3, form.cross23, dot(h2, v), dot(h3, p34), dot(v, v), sign[1], quality);
      out.q[2] = angle_between(h3, p34, u, quality);
      out.q[1] = angle_between(h2, u, v, quality);
      return;
    }
    case Closure::parallel_12: {
      out.q[2] = solve_angle(form.shoulder, dot(h1, w) - T(form.rest), sign[0], quality);
      const Vec<T> arm = arm_at(out.q[2]);
      const T axial = dot(h2, arm);
      const T rest = T(0.5) * (dot(w, w) - dot(p12, p12) - dot(arm, arm));
      out.q[1] = solve_angle(dot(p12, arm) - axial * dot(h2, p12), dot(p12, cross(h2, arm)),
                             rest - axial * dot(h2, p12), sign[1], quality);
      out.q[0] = angle_between(h1, add(p12, T(1.0), turned(h2, out.q[1], arm)), w, quality);
      return;
    }
    case Closure::three_parallel:
      return;
  }
}

/// Joints 4 to 6, whose axes meet, after joints 1 to 3.
template <typename T, typename Q>
IKSEL_INLINE void turn_wrist(const ClosedForm& form, const BranchTarget<T>& target, const T& sign,
                             Branch<T, Q>& out) {
  const Vec<T> h4 = constant<T>(form.h[3]);
  const Vec<T> h5 = constant<T>(form.h[4]);
  const Vec<T> h6 = constant<T>(form.h[5]);
  const auto before = [&](const Vec<T>& v) __attribute__((always_inline)) {
    const Vec<T> v1 = turned_back(constant<T>(form.h[0]), out.q[0], v);
    const Vec<T> v2 = turned_back(constant<T>(form.h[1]), out.q[1], v1);
    return turned_back(constant<T>(form.h[2]), out.q[2], v2);
  };
  // R_4 R_5 R_6 takes h6 to `axis`, and the first of the basis to `side`.
  const Vec<T> axis = before(target.Z);
  const Vec<T> side = before(target.X);
  out.q[4] = solve_angle(form.wrist, dot(h4, axis), sign, out.quality);
  out.q[3] = angle_between(h4, turned(h5, out.q[4], h6), axis, out.quality);
  const Vec<T> rest = turned_back(h5, out.q[4], turned_back(h4, out.q[3], side));
  out.q[5] = {dot(constant<T>(form.basis[0]), rest), dot(constant<T>(form.basis[1]), rest)};
}

/// All six joints of three parallel axes.
template <typename T, typename Q>
IKSEL_INLINE void solve_three_parallel(const ClosedForm& form, const BranchTarget<T>& target,
                                       const T (&sign)[3], Branch<T, Q>& out) {
  Q& quality = out.quality;
  const Vec<T> h1 = constant<T>(form.h[0]);
  const Vec<T> h = constant<T>(form.h[1]);
  const Vec<T> h5 = constant<T>(form.h[4]);
  const Vec<T> p34 = constant<T>(form.p[2]);
  const Vec<T>& w = target.w;
  const T along1 = dot(h1, w);
  const Vec<T> h1w = cross(h1, w);
  out.q[0] = solve_angle(dot(h, w) - T(form.cross12) * along1, T(0.0) - dot(h, h1w),
                         T(form.rest) - T(form.cross12) * along1, sign[0], quality);
  const auto before = [&](const Vec<T>& v) { return turned_back(h1, out.q[0], v); };
  // h . R_1^T R_06 h6 = h . R_5 h6, and R_06^T R_1 h = R_6^T R_5^T h.
  const Vec<T> X = before(target.X);
  const Vec<T> Y = before(target.Y);
  const Vec<T> Z = before(target.Z);
  out.q[4] = solve_angle(form.wrist, dot(h, Z), sign[2], quality);
  const Vec<T> from = turned_back(h5, out.q[4], h);
  const T u = dot(constant<T>(form.basis[0]), from);
  const T v = dot(constant<T>(form.basis[1]), from);
  const T x = dot(X, h);
  const T y = dot(Y, h);
  // Of (u, v) = R(q6) (x, y).
  out.q[5] = normalized(u * x + v * y, v * x - u * y, quality);
  const T& c = out.q[5].c;
  const T& s = out.q[5].s;
  // R_2 R_3 R_4 turns about h, and so a vector e across it: R_2 R_3 R_4 e = R_1^T R_06 R_6^T R_5^T
  // e.
  const Vec<T> e = constant<T>(form.across);
  const Vec<T> back = turned_back(h5, out.q[4], e);
  const T b0 = dot(constant<T>(form.basis[0]), back);
  const T b1 = dot(constant<T>(form.basis[1]), back);
  const T b2 = dot(constant<T>(form.basis[2]), back);
  // R_6^T in the basis.
  const T r0 = c * b0 + s * b1;
  const T r1 = c * b1 - s * b0;
  const Vec<T> ahead{r0 * X.x + r1 * Y.x + b2 * Z.x, r0 * X.y + r1 * Y.y + b2 * Z.y,
                     r0 * X.z + r1 * Y.z + b2 * Z.z};
  const Angle<T> all = angle_between(h, e, ahead, quality);
  const Vec<T> reach = add(add(before(w), T(-1.0), constant<T>(form.p[0])), T(-1.0),
                           turned(h, all, constant<T>(form.p[3])));
  const Angle<T> about =
      solve_angle(form.elbow, T(0.5) * (dot(reach, reach) - T(form.arm2)), sign[1], quality);
  const Vec<T> arm = add(constant<T>(form.p[1]), T(1.0), turned(h, about, p34));
  out.q[1] = angle_between(h, arm, reach, quality);
  out.q[2] = {about.c, T(form.side3) * about.s};
  // all = q2 + about + side4 q4.
  const Angle<T> two{out.q[1].c * about.c - out.q[1].s * about.s,
                     out.q[1].s * about.c + out.q[1].c * about.s};
  out.q[3] = {all.c * two.c + all.s * two.s, T(form.side4) * (all.s * two.c - all.c * two.s)};
}

inline constexpr double kWholeTurn = 6.28318530717958647693;

/// The joint values, and how far they are outside of their limits.
template <typename T, typename Q>
IKSEL_INLINE void store_joints(const ClosedForm& form, const Branch<T, Q>& branch, int first,
                               BranchPack& pack) {
  T beyond = T(0.0);
  for (int j = 0; j < 6; ++j) {
    T q = to_radians(branch.q[j]) - T(form.offset[j]);
    // The image nearest to the middle of the limits lies inside them if one does.
    const T turns = nearest_integer((T(form.middle[j]) - q) * T(1 / kWholeTurn));
    q = q + T(kWholeTurn) * turns;
    beyond = max(beyond, abs(q - T(form.middle[j])) - T(form.reach[j]));
    Lanes<T>::store(q, pack.q[j] + first);
  }
  Lanes<T>::store(beyond, pack.beyond + first);
  Lanes<T>::store(branch.quality.least, pack.least + first);
}

/// The lanes from `first` on.
template <typename T, typename Q>
IKSEL_INLINE Branch<T, Q> solve_branch(const ClosedForm& form, int first, Q quality,
                                       BranchPack& pack) {
  const auto vector = [&](int i) {
    return Vec<T>{T(pack.target[i]), T(pack.target[i + 1]), T(pack.target[i + 2])};
  };
  BranchTarget<T> target{vector(0), vector(3), vector(6), vector(9)};
  if (form.is_held) hold(form, Lanes<T>::load(pack.held + first), target);
  const T sign[3] = {Lanes<T>::load(pack.sign[0] + first), Lanes<T>::load(pack.sign[1] + first),
                     Lanes<T>::load(pack.sign[2] + first)};
  Branch<T, Q> branch;
  branch.quality = quality;
  if (form.closure == Closure::three_parallel) {
    solve_three_parallel(form, target, sign, branch);
  } else {
    place_wrist(form, target, sign, branch);
    turn_wrist(form, target, sign[2], branch);
  }
  store_joints(form, branch, first, pack);
  return branch;
}

/// Of a form without a held joint, and how certain it is.
template <typename T>
void solve_branches(const ClosedForm& form, BranchPack& pack) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    Certainty<T> start;
    start.error = T(form.error);
    const Certainty<T> quality = solve_branch<T>(form, first, start, pack).quality;
    Lanes<T>::store(quality.best, pack.best + first);
    Lanes<T>::store(quality.worst, pack.worst + first);
    Lanes<T>::store(quality.error / quality.scale, pack.error + first);
  }
}

/// Of any form, without `best`, `worst` and `error`.
template <typename T>
void find_branches(const ClosedForm& form, BranchPack& pack) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    solve_branch<T>(form, first, Existence<T>{}, pack);
  }
}

}  // namespace iksel::lanes
