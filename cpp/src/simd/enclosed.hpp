// SPDX-License-Identifier: BSD-3-Clause
// Numbers that depend on a parameter x in -1 .. 1, known up to an error: Taylor models of first
// order (Makino and Berz, "Taylor models and other validated functional inclusion methods", 2003).
// What is computed with them holds for every x and everything within the errors, rounding included.
#pragma once

#include "simd/branch_math.hpp"

/// Called, not inlined: hundreds of them make a branch.
#define IKSEL_APART __attribute__((noinline))

namespace iksel::lanes {

/// Every f with |f(x) - value - slope x| <= radius for all x in -1 .. 1, lane by lane.
template <typename T>
class Enclosed {
 public:
  IKSEL_INLINE Enclosed() = default;
  IKSEL_INLINE explicit Enclosed(double number) : value_(number), slope_(0.0), radius_(0.0) {}
  IKSEL_INLINE Enclosed(const T& value, const T& slope, const T& radius)
      : value_(value), slope_(slope), radius_(radius) {}

  /// At x = 0, but for the error.
  [[nodiscard]] IKSEL_INLINE const T& value() const { return value_; }
  [[nodiscard]] IKSEL_INLINE const T& slope() const { return slope_; }
  [[nodiscard]] IKSEL_INLINE const T& radius() const { return radius_; }
  /// How far from there it may be.
  [[nodiscard]] IKSEL_INLINE T reach() const { return rounded(abs(slope_) + radius_, abs(value_)); }
  [[nodiscard]] IKSEL_INLINE T lower() const { return value_ - reach(); }
  [[nodiscard]] IKSEL_INLINE T upper() const { return value_ + reach(); }

  friend IKSEL_APART Enclosed operator+(const Enclosed& a, const Enclosed& b) {
    return rounded(a.value_ + b.value_, a.slope_ + b.slope_, a.radius_ + b.radius_,
                   abs(a.slope_) + abs(b.slope_));
  }
  friend IKSEL_APART Enclosed operator-(const Enclosed& a, const Enclosed& b) {
    return rounded(a.value_ - b.value_, a.slope_ - b.slope_, a.radius_ + b.radius_,
                   abs(a.slope_) + abs(b.slope_));
  }
  friend IKSEL_APART Enclosed operator*(const Enclosed& a, const Enclosed& b) {
    const T ab = a.value_ * b.slope_;
    const T ba = b.value_ * a.slope_;
    // x^2 is 1/2, give or take 1/2.
    const T half = T(0.5) * a.slope_ * b.slope_;
    const T radius = abs(half) + (abs(a.value_) + abs(a.slope_)) * b.radius_ +
                     (abs(b.value_) + b.reach()) * a.radius_;
    return rounded(a.value_ * b.value_ + half, ab + ba, radius, abs(ab) + abs(ba));
  }
  /// Of a b that is above 0.
  friend IKSEL_INLINE Enclosed operator/(const Enclosed& a, const Enclosed& b) {
    return a * b.inverse();
  }
  template <typename Mask>
  friend IKSEL_INLINE Enclosed select(const Mask& mask, const Enclosed& a, const Enclosed& b) {
    return {select(mask, a.value_, b.value_), select(mask, a.slope_, b.slope_),
            select(mask, a.radius_, b.radius_)};
  }
  /// Of what of it is not below 0.
  friend IKSEL_APART Enclosed sqrt(const Enclosed& a) {
    const T lower = a.lower();
    const T root = sqrt(max(a.value_, T(0.0)));
    const T inverse = T(0.5) / max(root, T(kLeast));
    const Enclosed whole =
        a.bent(root, inverse, sqrt(max(lower, T(0.0))) - root + a.reach() * inverse);
    const Enclosed part = between(T(0.0), sqrt(max(a.upper(), T(0.0))));
    return select(lower > T(kLeast), whole, part);
  }
  friend IKSEL_APART Enclosed max(const Enclosed& a, const Enclosed& b) {
    const Enclosed both = between(max(a.lower(), b.lower()), max(a.upper(), b.upper()));
    return select(b.lower() >= a.upper(), b, select(a.lower() >= b.upper(), a, both));
  }
  friend IKSEL_APART Enclosed min(const Enclosed& a, const Enclosed& b) {
    const Enclosed both = between(min(a.lower(), b.lower()), min(a.upper(), b.upper()));
    return select(b.lower() >= a.upper(), a, select(a.lower() >= b.upper(), b, both));
  }
  friend IKSEL_INLINE Enclosed abs(const Enclosed& a) { return max(a, Enclosed(0.0) - a); }
  friend IKSEL_APART void sincos(const Enclosed& a, Enclosed& sine, Enclosed& cosine) {
    T s, c;
    iksel::sincos(a.value_, s, c);
    const T reach = a.reach();
    const T rest = T(0.5) * reach * reach;
    // Of each the error is that of numbers up to 1.
    const T size = abs(a.slope_) + T(1.0);
    sine = rounded(s, c * a.slope_, abs(c) * a.radius_ + rest, size);
    cosine = rounded(c, T(0.0) - s * a.slope_, abs(s) * a.radius_ + rest, size);
  }

  /// An error with what rounding adds to it, of numbers of that size.
  static IKSEL_INLINE T rounded(const T& radius, const T& size) {
    return radius + T(kRounding) * (size + radius);
  }
  static IKSEL_INLINE Enclosed rounded(const T& value, const T& slope, const T& radius,
                                       const T& size) {
    return {value, slope, rounded(radius, abs(value) + size)};
  }

 private:
  /// Of what is added up in an operation.
  static constexpr double kRounding = 3e-15;
  /// Numbers that may be below have any inverse.
  static constexpr double kLeast = 1e-60;

  static IKSEL_INLINE Enclosed between(const T& lower, const T& upper) {
    const T reach = T(0.5) * (upper - lower);
    return rounded(T(0.5) * (upper + lower), T(0.0), reach, reach);
  }
  [[nodiscard]] IKSEL_APART Enclosed inverse() const {
    const T lowest = max(lower(), T(kLeast));
    const T at = T(1.0) / max(value_, T(kLeast));
    const T rise = at * at;
    const Enclosed any(T(0.0), T(0.0), T(1 / kLeast));
    return select(lower() > T(kLeast),
                  bent(at, T(0.0) - rise, T(1.0) / lowest - at - rise * reach()), any);
  }
  /// A function that is `at` at value(), rises by `rise` there, and by its bend goes up to so far
  /// to one side of the tangent.
  [[nodiscard]] IKSEL_INLINE Enclosed bent(const T& at, const T& rise, const T& bend) const {
    const T half = T(0.5) * bend;
    const T slope = rise * slope_;
    return rounded(at + half, slope, abs(half) + abs(rise) * radius_, abs(slope) + abs(at));
  }

  T value_, slope_, radius_;
};

/// An angle of which nothing else is known has a cosine and a sine from -1 to 1.
template <typename T>
IKSEL_INLINE Angle<Enclosed<T>> angle_of(const Enclosed<T>& c, const Enclosed<T>& s) {
  const Enclosed<T> any(T(0.0), T(0.0), T(1.0));
  return {select(c.reach() < T(1.0), c, any), select(s.reach() < T(1.0), s, any)};
}

/// The direction of (c, s): errors count only across it.
template <typename T, typename Q>
IKSEL_APART Angle<Enclosed<T>> normalized(const Enclosed<T>& c, const Enclosed<T>& s,
                                          Q& /*quality*/) {
  const auto size = [](const T& x, const T& y) { return sqrt(x * x + y * y); };
  const T at_zero = max(size(c.value(), s.value()), T(1e-30));
  const T inverse = T(1.0) / at_zero;
  // The least size for any x; where all may be 0, no bound comes out below 1.
  const T least = max(at_zero - size(c.slope(), s.slope()), T(1e-30));
  const T short_of_it = T(1.0) / least;
  const T turn = c.value() * s.slope() - s.value() * c.slope();
  // Of the straight way that value and slope are, the angle's first and second derivative, at most;
  // and the angle that the error is seen under, whose sine it is at most.
  const T first = abs(turn) * short_of_it * short_of_it;
  const T second = T(2.0) * first * size(c.slope(), s.slope()) * short_of_it;
  const T sine = size(c.radius(), s.radius()) * short_of_it;
  const T angle = sine * (T(1.0) + T(0.6) * sine * sine);
  const T radius = select(sine < T(1.0), angle + T(0.5) * (first * first + second), T(1e30));
  const T speed = turn * inverse * inverse;
  const T cosine = c.value() * inverse;
  const T side = s.value() * inverse;
  return angle_of(Enclosed<T>::rounded(cosine, T(0.0) - speed * side, radius, abs(speed)),
                  Enclosed<T>::rounded(side, speed * cosine, radius, abs(speed)));
}

template <typename T>
IKSEL_INLINE T length(const Vec<T>& v) {
  return sqrt(dot(v, v));
}
template <typename T>
IKSEL_INLINE Vec<T> sizes(const Vec<T>& v) {
  return {abs(v.x), abs(v.y), abs(v.z)};
}

/// Every v with |v(x) - value - slope x| <= radius, and in each of its components no more than
/// `radii`: rotations leave the one as it is, and the other along their axis.
template <typename T>
struct Vec<Enclosed<T>> {
  Vec<T> value, slope, radii;
  T radius;

  IKSEL_INLINE Vec() = default;
  /// With what rounding adds to errors of numbers of that size.
  IKSEL_INLINE Vec(const Vec<T>& at, const Vec<T>& by, const Vec<T>& of_each, const T& of_all,
                   const T& size)
      : value(at), slope(by), radius(Enclosed<T>::rounded(of_all, size)) {
    const auto held = [&](const T& of_one) {
      return Enclosed<T>::rounded(min(of_one, of_all), size);
    };
    radii = {held(of_each.x), held(of_each.y), held(of_each.z)};
  }
  IKSEL_INLINE Vec(const Enclosed<T>& x, const Enclosed<T>& y, const Enclosed<T>& z)
      : value{x.value(), y.value(), z.value()},
        slope{x.slope(), y.slope(), z.slope()},
        radii{x.radius(), y.radius(), z.radius()},
        radius(length(radii)) {}

  /// No less than the length of any of them, and than each component, but for the error.
  [[nodiscard]] IKSEL_INLINE T size() const { return length(value) + length(slope); }
  [[nodiscard]] IKSEL_INLINE Vec<T> each_size() const { return sizes(value) + sizes(slope); }
};

template <typename T>
IKSEL_APART Enclosed<T> dot(const Vec<Enclosed<T>>& a, const Vec<Enclosed<T>>& b) {
  const T half = T(0.5) * dot(a.slope, b.slope);
  const T size_a = a.size();
  const T size_b = b.size();
  const T by_b = min(size_a * b.radius, dot(a.each_size(), b.radii));
  const T by_a = min(size_b * a.radius, dot(b.each_size(), a.radii));
  const T by_both = min(a.radius * b.radius, dot(a.radii, b.radii));
  return Enclosed<T>::rounded(dot(a.value, b.value) + half,
                              dot(a.value, b.slope) + dot(a.slope, b.value),
                              abs(half) + by_b + by_a + by_both, size_a * size_b);
}
template <typename T>
IKSEL_APART Vec<Enclosed<T>> cross(const Vec<Enclosed<T>>& a, const Vec<Enclosed<T>>& b) {
  const Vec<T> half = scaled(T(0.5), cross(a.slope, b.slope));
  const T size_a = a.size();
  const T size_b = b.size();
  const auto spread = [](const Vec<T>& u, const Vec<T>& v) {
    return Vec<T>{u.y * v.z + u.z * v.y, u.z * v.x + u.x * v.z, u.x * v.y + u.y * v.x};
  };
  const Vec<T> by_errors =
      spread(a.each_size() + a.radii, b.radii) + spread(a.radii, b.each_size());
  return {cross(a.value, b.value) + half, cross(a.value, b.slope) + cross(a.slope, b.value),
          sizes(half) + by_errors,
          length(half) + size_a * b.radius + (size_b + b.radius) * a.radius, size_a * size_b};
}
template <typename T>
IKSEL_APART Vec<Enclosed<T>> scaled(const Enclosed<T>& s, const Vec<Enclosed<T>>& a) {
  const Vec<T> half = scaled(T(0.5) * s.slope(), a.slope);
  const T size_s = abs(s.value()) + abs(s.slope());
  const T size_a = a.size();
  const T most = size_s + s.radius();
  const Vec<T> by_errors = scaled(s.radius(), a.each_size()) + scaled(most, a.radii);
  return {add(half, s.value(), a.value), add(scaled(s.value(), a.slope), s.slope(), a.value),
          sizes(half) + by_errors, length(half) + size_a * s.radius() + most * a.radius,
          size_s * size_a};
}
template <typename T>
IKSEL_APART Vec<Enclosed<T>> add(const Vec<Enclosed<T>>& a, const Enclosed<T>& s,
                                 const Vec<Enclosed<T>>& b) {
  const Vec<Enclosed<T>> more = scaled(s, b);
  return {a.value + more.value, a.slope + more.slope, a.radii + more.radii, a.radius + more.radius,
          a.size() + more.size()};
}
/// About a k that is constant.
template <typename T>
IKSEL_APART Vec<Enclosed<T>> turned(const Vec<Enclosed<T>>& k, const Angle<Enclosed<T>>& t,
                                    const Vec<Enclosed<T>>& v) {
  // What lies along k stays; what lies across turns, its value and its slope.
  const Vec<T>& axis = k.value;
  const auto turn = [&](const T& c, const T& s, const Vec<T>& of) {
    return add(scaled(c, of), s, cross(axis, of));
  };
  const T along = dot(axis, v.value);
  const T along_slope = dot(axis, v.slope);
  const Vec<T> value = add(v.value, T(0.0) - along, axis);
  const Vec<T> slope = add(v.slope, T(0.0) - along_slope, axis);
  const Vec<T> half = turn(T(0.5) * t.c.slope(), T(0.5) * t.s.slope(), slope);
  const Vec<T> at = add(turn(t.c.value(), t.s.value(), value), along, axis) + half;
  const Vec<T> by = add(turn(t.c.value(), t.s.value(), slope), along_slope, axis) +
                    turn(t.c.slope(), t.s.slope(), value);
  // The angle itself is one of a circle, whatever its enclosure: it leaves errors as they are.
  const T off = sqrt(t.c.radius() * t.c.radius() + t.s.radius() * t.s.radius());
  const T radius = v.radius + off * (length(value) + length(slope)) + length(half);
  const T radius_along = min(v.radius, dot(sizes(axis), v.radii));
  const auto of_each = [&](const T& n) {
    return abs(n) * radius_along + sqrt(max(T(1.0) - n * n, T(0.0))) * radius;
  };
  return {at, by, {of_each(axis.x), of_each(axis.y), of_each(axis.z)}, radius, v.size()};
}

}  // namespace iksel::lanes
