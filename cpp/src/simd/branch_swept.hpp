// SPDX-License-Identifier: BSD-3-Clause
// Six joints in closed form for an angle of one of them, but for a residual (branch_kernel.hpp).
#pragma once

#include "simd/branch_arm.hpp"

namespace iksel::lanes {

/// Joints 1 to 3, of which 2 and 3 are parallel, bring the end of a forearm, as it is with joint 3
/// at zero, to w. Whether that is enough.
template <typename T, typename Q>
IKSEL_INLINE bool place_forearm(const ClosedForm& form, const Vec<T>& forearm, const Vec<T>& w,
                                const T (&sign)[3], Branch<T, Q>& out) {
  const Vec<T> h2 = constant<T>(form.h[1]);
  const Vec<T> h3 = constant<T>(form.h[2]);
  const Vec<T> p23 = constant<T>(form.p[1]);
  out.q[0] = turn_base(form, h2, w, T(form.rest) + dot(h2, forearm), sign[0], out.quality);
  if (is_enough(form, 0, out)) return true;
  const Vec<T> v = behind_base(form, out.q[0], w);
  const T axial = dot(h3, p23) * dot(h3, forearm);
  const T rest = T(0.5) * (dot(v, v) - dot(p23, p23) - dot(forearm, forearm));
  out.q[2] = solve_angle(dot(p23, forearm) - axial, dot(p23, cross(h3, forearm)), rest - axial,
                         sign[1], out.quality);
  if (is_enough(form, 2, out)) return true;
  out.q[1] = angle_between(h2, add(p23, T(1.0), turned(h3, out.q[2], forearm)), v, out.quality);
  return is_enough(form, 1, out);
}

/// All six joints for an angle of joint 4, by the way that it leaves to where axes 5 and 6 meet.
template <typename T, typename Q>
IKSEL_INLINE void solve_sweep_4(const ClosedForm& form, const BranchTarget<T>& target,
                                const Angle<T>& q4, const T (&sign)[3], Branch<T, Q>& out,
                                T& residual) {
  const Vec<T> h5 = constant<T>(form.h[4]);
  const Vec<T> h6 = constant<T>(form.h[5]);
  const Vec<T> forearm = add(turned(constant<T>(form.h[3]), q4, constant<T>(form.p[3])), T(1.0),
                             constant<T>(form.p[2]));
  out.q[3] = q4;
  if (is_enough(form, 3, out)) return;
  if (place_forearm(form, forearm, target.w, sign, out)) return;
  const auto before = [&](const Vec<T>& v) __attribute__((always_inline)) {
    return turned_back(constant<T>(form.h[3]), q4, before_wrist(form, out, v));
  };
  const Vec<T> axis = before(target.Z);
  residual = dot(h5, axis) - T(form.along56);
  out.q[4] = angle_between(h5, h6, axis, out.quality);
  const Vec<T> rest = turned_back(h5, out.q[4], before(target.X));
  out.q[5] = {dot(constant<T>(form.basis[0]), rest), dot(constant<T>(form.basis[1]), rest)};
}

/// All six joints for an angle of joint 6, which leaves a target for the others.
template <typename T, typename Q>
IKSEL_INLINE void solve_sweep_6(const ClosedForm& form, const BranchTarget<T>& target,
                                const Angle<T>& q6, const T (&sign)[3], Branch<T, Q>& out,
                                T& residual) {
  const Vec<T> h4 = constant<T>(form.h[3]);
  const Vec<T> h5 = constant<T>(form.h[4]);
  const Vec<T> h6 = constant<T>(form.h[5]);
  // R_05 of a vector.
  const auto ahead = [&](const Vec<T>& v) __attribute__((always_inline)) {
    const T x = dot(constant<T>(form.basis[0]), v);
    const T y = dot(constant<T>(form.basis[1]), v);
    const Vec<T> along{T(0.0), T(0.0), T(0.0)};
    return add(add(add(along, q6.c * x + q6.s * y, target.X), q6.c * y - q6.s * x, target.Y),
               dot(h6, v), target.Z);
  };
  const Vec<T> w = add(target.w, T(-1.0), ahead(constant<T>(form.p[4])));
  out.q[5] = q6;
  if (place_forearm(form, constant<T>(form.p[2]), w, sign, out)) return;
  const Vec<T> axis = before_wrist(form, out, ahead(h5));
  residual = dot(h4, axis) - T(form.along45);
  out.q[3] = angle_between(h4, h5, axis, out.quality);
  const Vec<T> rest = turned_back(h4, out.q[3], before_wrist(form, out, target.Z));
  out.q[4] = angle_between(h5, h6, rest, out.quality);
}

/// The one or the other of them.
template <typename T, typename Q>
IKSEL_INLINE void solve_residual(const ClosedForm& form, const BranchTarget<T>& target,
                                 const T& angle, const T (&sign)[3], Branch<T, Q>& out,
                                 T& residual) {
  Angle<T> t;
  sincos(angle, t.s, t.c);
  if (form.closure == Closure::sweep_4) {
    solve_sweep_4(form, target, t, sign, out, residual);
  } else {
    solve_sweep_6(form, target, t, sign, out, residual);
  }
}

}  // namespace iksel::lanes
