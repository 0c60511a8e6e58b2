// SPDX-License-Identifier: BSD-3-Clause
// The residual of six joints by one angle, whose roots are the angles of all solutions: the product
// of what each branch is off by, as a polynomial. Branches end where two of them meet and become
// complex; their product goes on.
//
// With s = +-sqrt(A^2 + B^2 - C^2), cos(q1) = (A C - B s) / (A^2 + B^2), sin(q1) likewise: numbers
// x + y s, which are multiplied as such, without a root being taken. Of joint 3, both angles are
// multiplied out at once: seen along axis 2 as complex numbers, with a the way from axis 3 to the
// point, w that from axis 2 to it, N = |a|^2, W = |w|^2, Y = W - |p23|^2 + N, m = conj(k) d and
// z = conj(w) a m, the two angles E = exp(i (q2 + q3)) have the sum w conj(a) Y / (W N) and the
// product w^2 conj(a)^2 / (W N), and k0 + Re(conj(E) m) = 0 for one of them where
//   k0^2 W N + k0 Y Re(z) + |m|^2 Y^2 / 4 - Im(z)^2 = 0.
#pragma once

#include "simd/branch_types.hpp"
#include "simd/lane_math.hpp"

namespace iksel::lanes {

/// x + y s
template <typename T>
struct Surd {
  T x, y;
};

template <typename T>
IKSEL_INLINE Surd<T> operator+(const Surd<T>& a, const Surd<T>& b) {
  return {a.x + b.x, a.y + b.y};
}
template <typename T>
IKSEL_INLINE Surd<T> operator-(const Surd<T>& a, const Surd<T>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <typename T>
IKSEL_INLINE Surd<T> operator*(const T& f, const Surd<T>& a) {
  return {f * a.x, f * a.y};
}
/// Numbers with s^2 = `square`.
template <typename T>
struct Surds {
  T square;
  IKSEL_INLINE Surd<T> product(const Surd<T>& a, const Surd<T>& b) const {
    return {a.x * b.x + a.y * b.y * square, a.x * b.y + a.y * b.x};
  }
  IKSEL_INLINE Surd<T> squared(const Surd<T>& a) const {
    return {a.x * a.x + a.y * a.y * square, T(2.0) * a.x * a.y};
  }
};

template <typename T>
IKSEL_INLINE T residual_at(const ResidualForm& form, const T& angle, T& least) {
  T sine, cosine;
  sincos(angle, sine, cosine);
  const auto at = [&](const Linear& v) __attribute__((always_inline)) {
    return T(v.one) + T(v.c) * cosine + T(v.s) * sine;
  };
  const T A = at(form.A);
  const T B = at(form.B);
  const T C = at(form.C);
  const T R = A * A + B * B;
  least = min(least, R);
  const T inverse = T(1.0) / max(R, T(1e-30));
  const Surds<T> in{R - C * C};
  const Surd<T> c1{A * C * inverse, T(0.0) - B * inverse};
  const Surd<T> s1{B * C * inverse, A * inverse};
  const auto behind_base = [&](const Linear(&v)[3]) __attribute__((always_inline)) {
    const T c = at(v[1]);
    const T s = at(v[2]);
    return Surd<T>{at(v[0]) + c * c1.x + s * s1.x, c * c1.y + s * s1.y};
  };
  const Surd<T> wx = behind_base(form.w[0]);
  const Surd<T> wy = behind_base(form.w[1]);
  const Surd<T> dx = behind_base(form.d[0]);
  const Surd<T> dy = behind_base(form.d[1]);
  const Surd<T> dz = behind_base(form.d[2]);
  const T ax = at(form.a[0]);
  const T ay = at(form.a[1]);
  const T kx = at(form.k[0]);
  const T ky = at(form.k[1]);
  const T kz = at(form.k[2]);

  const T N = ax * ax + ay * ay;
  const Surd<T> W = in.squared(wx) + in.squared(wy);
  const Surd<T> Y{W.x + (N - T(form.p23_2)), W.y};
  const Surd<T> k0{kz * dz.x - T(form.along), kz * dz.y};
  const Surd<T> m_re = kx * dx + ky * dy;
  const Surd<T> m_im = kx * dy - ky * dx;
  const Surd<T> wa_re = ax * wx + ay * wy;
  const Surd<T> wa_im = ay * wx - ax * wy;
  const Surd<T> z_re = in.product(wa_re, m_re) - in.product(wa_im, m_im);
  const Surd<T> z_im = in.product(wa_re, m_im) + in.product(wa_im, m_re);
  const Surd<T> m2 = (kx * kx + ky * ky) * (in.squared(dx) + in.squared(dy));
  const Surd<T> Y2m2 = in.product(in.squared(Y), m2);
  const Surd<T> both = in.product(k0, N * in.product(k0, W) + in.product(Y, z_re)) +
                       T(0.25) * Y2m2 - in.squared(z_im);
  return (both.x * both.x - both.y * both.y * in.square) * (R * R);
}

/// At `n` angles [rad], a multiple of kWidth. Returns the least A^2 + B^2: how near to axis 1 the
/// point P comes.
template <typename T>
double find_residuals(const ResidualForm& form, const double* angles, int n, double* residuals) {
  T least = T(1e30);
  for (int i = 0; i < n; i += Lanes<T>::kCount) {
    Lanes<T>::store(residual_at(form, Lanes<T>::load(angles + i), least), residuals + i);
  }
  double lanes[kWidth];
  Lanes<T>::store(least, lanes);
  double all = lanes[0];
  for (int i = 1; i < Lanes<T>::kCount; ++i) all = min(all, lanes[i]);
  return all;
}

/// Sign changes along the coefficients, at most: inner ones may be off by the margin.
template <typename T>
IKSEL_INLINE T most_sign_changes(const T (&b)[6], const T& margin) {
  T changes = T(0.0);
  T sign = select(b[0] < T(0.0), T(-1.0), T(1.0));
  for (int i = 1; i < 6; ++i) {
    T next = select(b[i] < T(0.0), T(-1.0), T(1.0));
    if (i < 5) next = select(abs(b[i]) > margin, next, T(0.0) - sign);
    changes = changes + T(0.5) * abs(next - sign);
    sign = next;
  }
  return changes;
}

/// Whether the parabola through three values turns between them and comes to 0 there, or has its
/// roots no farther from there than `apart` steps: where real ones are near, and the values do not
/// change their sign, the function is flatter.
template <typename T>
IKSEL_INLINE auto all_but_touches(const T& before, const T& at, const T& after, const T& apart) {
  const T slope = T(0.5) * (after - before);
  const T bend = after - T(2.0) * at + before;
  const T bend2 = bend * bend;
  return (at * bend > T(0.0)) & (slope * slope <= T(0.25) * bend2) &
         (at * bend - T(0.5) * slope * slope <= T(0.5) * apart * apart * bend2);
}

/// For each of `n` cells between two of the evenly spaced values and the next, how many roots there
/// are: none, one, or 2 where that is not certain. By Descartes' rule of signs for the polynomial
/// of fifth degree through the six values around, in Bernstein form; what it may differ from the
/// function is told by the sixth difference. Nor is it certain where the values turn at an end of
/// the cell and all but reach 0 (all_but_touches). There are 3 values before the first and 4 after
/// the last cell's left one, and `n` is a multiple of kWidth.
template <typename T>
void count_roots(const double* values, int n, double apart, double* counts) {
  // For the first two inner coefficients; the other two are their mirror images.
  constexpr double kFirst[6] = {1.0 / 100, -1.0 / 10, 14.0 / 15, 1.0 / 5, -1.0 / 20, 1.0 / 150};
  constexpr double kSecond[6] = {19.0 / 1200, -2.0 / 15, 89.0 / 120, 7.0 / 15, -5.0 / 48, 1.0 / 75};
  for (int i = 0; i < n; i += Lanes<T>::kCount) {
    T v[8];
    for (int k = 0; k < 8; ++k) v[k] = Lanes<T>::load(values + i + k - 3);
    const auto sixth = [&](int k) __attribute__((always_inline)) {
      return abs(v[k] + v[k + 6] - T(6.0) * (v[k + 1] + v[k + 5]) +
                 T(15.0) * (v[k + 2] + v[k + 4]) - T(20.0) * v[k + 3]);
    };
    const T margin = T(0.02) * max(sixth(0), sixth(1));
    T b[6] = {v[3], T(0.0), T(0.0), T(0.0), T(0.0), v[4]};
    for (int k = 0; k < 6; ++k) {
      b[1] = b[1] + T(kFirst[k]) * v[1 + k];
      b[2] = b[2] + T(kSecond[k]) * v[1 + k];
      b[3] = b[3] + T(kSecond[5 - k]) * v[1 + k];
      b[4] = b[4] + T(kFirst[5 - k]) * v[1 + k];
    }
    const auto touches =
        all_but_touches(v[2], v[3], v[4], T(apart)) | all_but_touches(v[3], v[4], v[5], T(apart));
    const T count = min(most_sign_changes(b, margin), T(2.0));
    Lanes<T>::store(select(touches, T(2.0), count), counts + i);
  }
}

}  // namespace iksel::lanes
