// SPDX-License-Identifier: BSD-3-Clause
// Six joints whose axes lie anyhow, for an angle of one of them that lets their loop close: the
// others by the null vector of its products (loop_determinant.hpp).
#pragma once

#include "simd/loop_determinant.hpp"

namespace iksel::lanes {

inline constexpr int kProducts = 2 * kEquations;

/// Triangular products as one matrix m, by columns.
template <typename T>
struct NullSpace {
  T m[kProducts][kProducts];
  T inverse[kProducts];  ///< of the diagonal, as far as it is not 0

  IKSEL_INLINE explicit NullSpace(const Products<T>& products) {
    for (int i = 0; i < kAlone; ++i) {
      for (int k = 0; k < kAlone; ++k) {
        m[k][i] = products.half[0][k][i];
        m[kAlone + k][i] = T(0.0);
        m[kAlone + k][kAlone + i] = products.half[1][k][i];
      }
      for (int k = kAlone; k < kAlone + kEquations; ++k) {
        m[kAlone + k][i] = products.half[0][k][i];
        m[kAlone + k][kAlone + i] = products.half[1][k][i];
      }
    }
    for (int k = 0; k < kEquations; ++k) {
      for (int i = 0; i <= k; ++i) m[kEquations + k][kEquations + i] = products.rest[k][i];
    }
    for (int k = 0; k < kProducts; ++k) {
      const T size = max(abs(m[k][k]), T(1e-16) * abs(m[0][0]) + T(1e-200));
      inverse[k] = select(m[k][k] < T(0.0), T(-1.0), T(1.0)) / size;
    }
  }
  /// A step of inverse iteration, by (m^T m)^-1.
  IKSEL_INLINE void iterate(T (&x)[kProducts]) const {
    for (int k = 0; k < kProducts; ++k) {
      for (int i = 0; i < k; ++i) x[k] = x[k] - m[k][i] * x[i];
      x[k] = x[k] * inverse[k];
    }
    T square = T(0.0);
    for (int k = kProducts; k-- > 0;) {
      for (int j = k + 1; j < kProducts; ++j) x[k] = x[k] - m[j][k] * x[j];
      x[k] = x[k] * inverse[k];
      square = square + x[k] * x[k];
    }
    const T scale = T(1.0) / sqrt(square);
    for (int k = 0; k < kProducts; ++k) x[k] = x[k] * scale;
  }
  /// What m takes to nearly 0: the products with c^3, s^3, c^2 s and c s^2.
  IKSEL_INLINE void find_first(T (&x)[kProducts]) const {
    for (T& component : x) component = T(1.0);
    for (int step = 0; step < 2; ++step) iterate(x);
  }
  /// And that across x.
  IKSEL_INLINE void find_second(const T (&x)[kProducts], T (&y)[kProducts]) const {
    for (int k = 0; k < kProducts; ++k) y[k] = T(k % 2 == 0 ? 1.0 : -1.0);
    for (int step = 0; step < 3; ++step) {
      T share = T(0.0);
      for (int k = 0; k < kProducts; ++k) share = share + x[k] * y[k];
      for (int k = 0; k < kProducts; ++k) y[k] = y[k] - share * x[k];
      if (step < 2) iterate(y);
    }
  }
};

/// By how much cosines and sines of e are off, bilinear in x and y: 0 where both are those of one
/// angle.
template <typename T>
IKSEL_INLINE T off_circle(const T (&x)[kProducts], const T (&y)[kProducts]) {
  T off = T(0.0);
  for (int k = 0; k < kProducts; k += 3) {
    off = off + x[k + 1] * y[k + 1] + x[k + 2] * y[k + 2] - x[k] * y[k];
  }
  return off;
}

/// Of two solutions that share the angle of c, or all but do, products are any of a plane: turns x
/// to one of them, `sign` tells which.
template <typename T>
IKSEL_INLINE void take_one_of_pair(const NullSpace<T>& space, const T& sign, T (&x)[kProducts]) {
  T y[kProducts];
  space.find_second(x, y);
  // off_circle(a x + b y) = 0.
  const T xx = off_circle(x, x);
  const T xy = off_circle(x, y);
  const T yy = off_circle(y, y);
  const T root = sqrt(max(xy * xy - xx * yy, T(0.0)));
  const T sum = T(0.0) - xy - select(xy < T(0.0), T(0.0) - root, root);
  const auto is_first = sign > T(0.0);
  const T a = select(is_first, sum, yy);
  const T b = select(is_first, xx, sum);
  for (int k = 0; k < kProducts; ++k) x[k] = a * x[k] + b * y[k];
}

/// Angles d and e of a null vector.
template <typename T>
IKSEL_INLINE void read_products(const T (&x)[kProducts], Branch<T, Definiteness<T>>& out) {
  T c = T(0.0);
  T s = T(0.0);
  for (int k = 0; k < 4; ++k) {
    c = c + x[3 * k] * x[3 * k + 1];
    s = s + x[3 * k] * x[3 * k + 2];
  }
  out.q[2] = normalized(c, s, out.quality);
  const auto of_d = [&](int k) __attribute__((always_inline)) {
    return x[3 * k] + out.q[2].c * x[3 * k + 1] + out.q[2].s * x[3 * k + 2];
  };
  // c^3 + c s^2 = c, s^3 + c^2 s = s.
  const T half_c = of_d(0) + of_d(3);
  const T half_s = of_d(1) + of_d(2);
  out.q[1] = normalized(half_c * half_c - half_s * half_s, T(2.0) * half_c * half_s, out.quality);
}

/// A point, and directions, that move together.
template <typename T>
struct Moving {
  Vec<T> p, along, across;

  IKSEL_INLINE void turn(const double (&h)[3], const double (&at)[3], const Angle<T>& angle) {
    const Vec<T> axis = constant<T>(h);
    p = add(turned(axis, angle, add(p, T(-1.0), constant<T>(at))), T(1.0), constant<T>(at));
    along = turned(axis, angle, along);
    across = turned(axis, angle, across);
  }
  IKSEL_INLINE void move(const LoopTarget& target) {
    const auto rotated = [&](const Vec<T>& v) __attribute__((always_inline)) {
      const Vec<T> none{T(0.0), T(0.0), T(0.0)};
      return add(add(add(none, v.x, constant<T>(target.R[0])), v.y, constant<T>(target.R[1])), v.z,
                 constant<T>(target.R[2]));
    };
    p = add(rotated(p), T(1.0), constant<T>(target.t));
    along = rotated(along);
    across = rotated(across);
  }
};

/// cos(t) and sin(t) that satisfy x . R(k, t) y = rest for several x, y and rest as well as can be.
template <typename T>
struct LeastSquares {
  Vec<T> k;
  T cc = T(0.0), cs = T(0.0), ss = T(0.0), c = T(0.0), s = T(0.0);

  IKSEL_INLINE void add_row(const T& by_cosine, const T& by_sine, const T& rest) {
    cc = cc + by_cosine * by_cosine;
    cs = cs + by_cosine * by_sine;
    ss = ss + by_sine * by_sine;
    c = c + by_cosine * rest;
    s = s + by_sine * rest;
  }
  IKSEL_INLINE T by_cosine(const Vec<T>& x, const Vec<T>& y) const {
    return dot(x, y) - dot(k, x) * dot(k, y);
  }
  IKSEL_INLINE void add_equation(const Vec<T>& x, const Vec<T>& y, const T& rest) {
    add_row(by_cosine(x, y), dot(x, cross(k, y)), rest - dot(k, x) * dot(k, y));
  }
  template <typename Q>
  IKSEL_INLINE Angle<T> solve(Q& quality) const {
    quality.divide_by_product(sqrt(max(cc * ss - cs * cs, T(0.0))));
    Q ignored;
    return normalized(ss * c - cs * s, cc * s - cs * c, ignored);
  }
};

/// Joints b and a, which bring what c, d and e have moved back to axis f. About axis a, of a point
/// and a direction do not change: the distances of the point along the axis and from its own point,
/// the direction's share along the axis, its product with the way to the point, and its moment.
/// Where f, a and b meet or are parallel, one of these is left, and `sign` tells its two solutions
/// apart.
template <typename T, typename Q>
IKSEL_INLINE void turn_back(const LoopForm& form, const T& sign, Moving<T>& from,
                            Branch<T, Q>& out) {
  const Vec<T> ha = constant<T>(form.h[4]);
  const Vec<T> pa = constant<T>(form.p[4]);
  const Vec<T> pb = constant<T>(form.p[5]);
  const Vec<T> hf = constant<T>(form.h[3]);
  const Vec<T> goal = add(constant<T>(form.p[3]), T(-1.0), pa);
  const Vec<T> way = add(pb, T(-1.0), pa);
  const Vec<T> v = add(from.p, T(-1.0), pb);
  const Vec<T> hb = constant<T>(form.h[5]);
  const T distance = T(0.5) * (dot(goal, goal) - dot(way, way) - dot(v, v));
  const auto one_of_two = [&](const Vec<T>& x, const Vec<T>& y, const T& rest) {
    const T axial = dot(hb, x) * dot(hb, y);
    return solve_angle(dot(x, y) - axial, dot(x, cross(hb, y)), rest - axial, sign, out.quality);
  };
  if (form.rest == LoopForm::Rest::meet) {
    out.q[5] = one_of_two(ha, from.along, dot(ha, hf));
  } else if (form.rest == LoopForm::Rest::parallel) {
    out.q[5] = one_of_two(way, v, distance);
  } else {
    LeastSquares<T> b{hb};
    b.add_equation(ha, from.along, dot(ha, hf));
    b.add_equation(ha, v, dot(ha, add(goal, T(-1.0), way)));
    b.add_equation(way, v, distance);
    b.add_equation(way, from.along, dot(goal, hf) - dot(v, from.along));
    // The moment: (ha x way) . R along + ha . R (v x along).
    const Vec<T> lever = cross(ha, way);
    const Vec<T> moment = cross(v, from.along);
    b.add_row(b.by_cosine(lever, from.along) + b.by_cosine(ha, moment),
              dot(lever, cross(hb, from.along)) + dot(ha, cross(hb, moment)),
              dot(ha, cross(goal, hf)) - dot(hb, lever) * dot(hb, from.along) -
                  dot(hb, ha) * dot(hb, moment));
    out.q[5] = b.solve(out.quality);
  }
  from.turn(form.h[5], form.p[5], out.q[5]);
  const Vec<T> arm = add(from.p, T(-1.0), pa);
  LeastSquares<T> a{ha};
  const T c = a.by_cosine(arm, goal) + a.by_cosine(from.along, hf);
  const T s = dot(goal, cross(ha, arm)) + dot(hf, cross(ha, from.along));
  out.q[4] = normalized(c, s, out.quality);
  from.turn(form.h[4], form.p[4], out.q[4]);
}

/// All six joints at the angles of c that the pack holds, and by how much the loop stays open
/// there: `residual`, in radians and units together. `are_pairs`: where two solutions all but share
/// an angle; the second of the signs tells them apart, or the first, if it does not tell two ways.
template <typename T>
void close_loops(const LoopForm& form, const LoopTarget& target, const ClosedForm& limits,
                 bool are_pairs, BranchPack& pack) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    Branch<T, Definiteness<T>> out;
    sincos(Lanes<T>::load(pack.held + first), out.q[0].s, out.q[0].c);
    Products<T> m[1];
    T determinant[1];
    fill_products(target, out.q[0], m[0]);
    make_triangular(m, determinant);
    T x[kProducts];
    const NullSpace<T> space(m[0]);
    space.find_first(x);
    if (are_pairs) {
      take_one_of_pair(space, Lanes<T>::load(pack.sign[form.has_two_ways()] + first), x);
    }
    read_products(x, out);
    Moving<T> moving{constant<T>(form.p[3]), constant<T>(form.h[3]), constant<T>(form.across)};
    for (int j = 2; j >= 0; --j) {
      if (form.before == j + 1) moving.move(target);
      moving.turn(form.h[j], form.p[j], out.q[j]);
    }
    if (form.before == 0) moving.move(target);
    turn_back(form, Lanes<T>::load(pack.sign[0] + first), moving, out);
    const Vec<T> hf = constant<T>(form.h[3]);
    const Vec<T> across = constant<T>(form.across);
    // What is left is a turn about axis f, of the others.
    out.q[3] = normalized(dot(moving.across, across),
                          T(0.0) - dot(moving.across, cross(hf, across)), out.quality);
    const Vec<T> off = add(moving.p, T(-1.0), constant<T>(form.p[3]));
    const Vec<T> tilt = add(moving.along, T(-1.0), hf);
    Lanes<T>::store(sqrt(dot(off, off) + dot(tilt, tilt)), pack.residual + first);
    store_branch(limits, out, first, pack);
  }
}

}  // namespace iksel::lanes
