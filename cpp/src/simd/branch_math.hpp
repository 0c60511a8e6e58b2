// SPDX-License-Identifier: BSD-3-Clause
// Subproblems of one and two angles (Paden 1986; Elias and Wen: "Canonical subproblems for robot
// inverse kinematics", 2022), lane by lane. Angles stay pairs of cosine and sine until the end.
#pragma once

#include "simd/branch_types.hpp"
#include "simd/lane_math.hpp"
#include "simd/lane_vector.hpp"

namespace iksel::lanes {

/// An angle by its cosine and sine.
template <typename T>
struct Angle {
  T c = T(1.0);
  T s = T(0.0);
};

/// The same of what was calculated: as it is, unless T knows that it is no more than 1.
template <typename T>
IKSEL_INLINE Angle<T> angle_of(const T& c, const T& s) {
  return {c, s};
}

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
/// pi / 8 at most, and by the arc sine, which the Chebyshev polynomial of its quotient by x in x^2
/// gives up to there to 2e-17 of itself.
template <typename T>
IKSEL_INLINE T to_radians(const Angle<T>& t) {
  const T c = abs(t.c);
  const T s = abs(t.s);
  const T low = min(c, s);
  const T high = max(c, s);
  const T x = low * T(0.92387953251128675613) - high * T(0.38268343236508977173);
  const T x2 = x * x;
  T a = polynomial(x2, 0.01762140671983341, 0.006102583241057098, 0.012318435689870904,
                   0.013867689439773496, 0.017360568997896245, 0.02237175960590779,
                   0.030381957126451947, 0.044642856908859295, 0.07500000000220788,
                   0.16666666666665855, 1.0);
  a = a * x + T(0.39269908169872415481);
  a = select(s > c, T(1.57079632679489661923) - a, a);
  a = select(t.c < T(0.0), T(3.14159265358979323846) - a, a);
  return select(t.s < T(0.0), T(0.0) - a, a);
}

/// How certain the angles found so far are, and what they say of the limits, as BranchPack has it.
template <typename T>
struct Certainty {
  T least = T(1.0);
  T best = T(1.0);
  T worst = T(1.0);
  /// Error of the angles so far: of this numerator and denominator, so as not to divide each time.
  T error;
  T scale = T(1.0);
  T of_target;
  T turned_error = T(0.0), turned_scale = T(1.0);  ///< the same of turn_way()
  T value[6]{};                                    ///< of the joints [rad]
  T beyond = T(-1e30);
  T outside = T(-1.0);
  /// Whether nothing more is asked of branches that are not inside the limits.
  bool stops_outside;

  IKSEL_INLINE Certainty(double error_of_target, bool stops)
      : error(error_of_target), of_target(error_of_target), stops_outside(stops) {}

  /// An angle follows from a quotient by a number of the size `size`.
  IKSEL_INLINE void divide_by(const T& size) {
    error = error * (size + T(1.0));
    scale = scale * max(size, T(1e-12));
  }
  /// The same by the product of two lengths, mostly equal ones.
  IKSEL_INLINE void divide_by_product(const T& product) { divide_by(sqrt(product)); }
  /// An angle follows from the root of `square`, the difference of squares of a number near to
  /// `near` where that is near 0. Roots differ by no more than the root of the squares' difference:
  /// the error of an angle on a circle of that size is at most the root of twice the error by it.
  IKSEL_INLINE void take_root(const T& square, const T& near, const T& root) {
    const T scaled = square * scale;
    const T of_square = T(2.0) * error * near;
    least = min(least, square);
    best = min(best, scaled + of_square);
    worst = min(worst, scaled - of_square);
    const T least_root = sqrt(T(0.5) * error * scale * min(near, T(1.0)));
    error = error * (root + T(1.0));
    scale = max(scale * root, least_root);
  }
  /// What follows is a way, of which the last angle turned a part of that length; until
  /// turn_rotation(), where all angles count again.
  IKSEL_INLINE void turn_way(double length) {
    turned_error = error;
    turned_scale = scale;
    error = min(error, error * T(length) + of_target * scale);
  }
  IKSEL_INLINE void turn_rotation() {
    error = max(error * turned_scale, turned_error * scale);
    scale = scale * turned_scale;
  }
  /// What is known now lies so far outside of limits, 0 or less if it does not [rad].
  IKSEL_INLINE void take_beyond(const T& of_limits) {
    beyond = max(beyond, of_limits);
    const T certainly = select(error < T(kVague) * scale, of_limits * scale - error, T(-1.0));
    outside = max(outside, certainly);
  }
  /// Whether no lane's branch is inside.
  [[nodiscard]] IKSEL_INLINE bool is_over() const {
    return stops_outside && !any(min(best, T(0.0) - outside) >= T(0.0));
  }
};

/// Whether there are such angles, and whether they are determined: the least of what they were
/// divided by is 0 where any angle would do.
template <typename T>
struct Definiteness {
  T least = T(1.0);
  T size2 = T(1.0);

  IKSEL_INLINE void divide_by_product(const T& product) { size2 = min(size2, product * product); }
  IKSEL_INLINE void take_root(const T& square, const T& /*near*/, const T& /*root*/) {
    least = min(least, square);
    size2 = min(size2, abs(square));
  }
  /// What an error of the target may have grown to in an angle, at least [rad].
  [[nodiscard]] IKSEL_INLINE T error(double of_target) const {
    return T(of_target) / sqrt(max(size2, T(1e-24)));
  }
};

/// One of the two angles with a cos(t) + b sin(t) = rest, where a^2 + b^2 = r2 = 1 / inverse. Where
/// there is none, about the nearest: cosine and sine are then more than 1 together, and what is
/// made of them means nothing.
template <typename T, typename Q>
IKSEL_INLINE Angle<T> solve_angle(const T& a, const T& b, const T& r2, const T& inverse,
                                  const T& rest, const T& sign, Q& quality) {
  const T square = r2 - rest * rest;
  const T root = sqrt(max(square, T(0.0)));
  quality.take_root(square, abs(rest), root);
  const T cosine = rest * inverse;
  const T sine = sign * root * inverse;
  return angle_of(a * cosine - b * sine, b * cosine + a * sine);
}
template <typename T, typename Q>
IKSEL_INLINE Angle<T> solve_angle(const T& a, const T& b, const T& rest, const T& sign,
                                  Q& quality) {
  const T r2 = a * a + b * b;
  return solve_angle(a, b, r2, T(1.0) / max(r2, T(1e-30)), rest, sign, quality);
}

/// One of the two angles with x . R(k, t) y = rest.
template <typename T, typename Q>
IKSEL_INLINE Angle<T> solve_angle(const Turned& turned, const T& rest, const T& sign, Q& quality) {
  return solve_angle(T(turned.a), T(turned.b), T(turned.r2), T(turned.inverse), rest - T(turned.c),
                     sign, quality);
}

/// The angle with cosine c and sine s times the product of two lengths, mostly equal ones.
template <typename T, typename Q>
IKSEL_INLINE Angle<T> normalized(const T& c, const T& s, Q& quality) {
  const T size2 = c * c + s * s;
  const T size = sqrt(max(size2, T(1e-60)));
  quality.divide_by_product(size);
  const auto none = size2 < T(1e-56);
  const T inverse = T(1.0) / size;
  return angle_of(select(none, T(1.0), c * inverse), select(none, T(0.0), s * inverse));
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
  // No less than the length, of 1 at most.
  quality.take_root(square, min(length2 + T(0.25), T(1.0)), root);
  const T gamma = sign * root * T(__builtin_sqrt(1.0 / (1.0 - c * c)));
  return add(add(scaled(alpha, k1), beta, k2), gamma, cross(k1, k2));
}

}  // namespace iksel::lanes
