// SPDX-License-Identifier: BSD-3-Clause
// Joints 1 to 3 of six in closed form (branch_kernel.hpp), by how their axes lie.
#pragma once

#include <type_traits>

#include "base/constants.hpp"
#include "simd/branch_math.hpp"
#include "simd/branch_types.hpp"

namespace iksel::lanes {

/// A pose as BranchPack has it.
template <typename T>
struct BranchTarget {
  Vec<T> X, Y, Z, w;
};

/// The targets in the lanes from `first` on.
template <typename T>
IKSEL_INLINE BranchTarget<T> load_target(const BranchPack& pack, int first) {
  const auto row = [&](int i) { return Lanes<T>::load(pack.target[i] + first); };
  const auto vector = [&](int i) { return Vec<T>{row(i), row(i + 1), row(i + 2)}; };
  return {vector(0), vector(3), vector(6), vector(9)};
}

/// The target of the joints behind the held one, at an angle of that, or a place of a slide.
template <typename T>
IKSEL_INLINE void hold(const ClosedForm& form, const T& value, BranchTarget<T>& target) {
  const Vec<T> axis = constant<T>(form.held_axis);
  if (form.held_slide != 0) {
    target.w = add(target.w, T(-form.held_slide) * value, axis);
    return;
  }
  Angle<T> t;
  sincos(value, t.s, t.c);
  const Vec<T> from = constant<T>(form.held_from);
  target.X = turned_back(axis, t, target.X);
  target.Y = turned_back(axis, t, target.Y);
  target.Z = turned_back(axis, t, target.Z);
  target.w = add(turned_back(axis, t, add(target.w, T(1.0), from)), T(-1.0), from);
}

/// Q is Certainty or Definiteness.
template <typename T, typename Q>
struct Branch {
  Angle<T> q[6];
  Q quality;
};

/// The joint value of an angle [rad]: of its images the one nearest to the middle of the limits,
/// which lies inside them if one does.
template <typename T>
IKSEL_INLINE T joint_value(const ClosedForm& form, int j, const Angle<T>& angle) {
  const T q = to_radians(angle) - T(form.offset[j]);
  const T turns = nearest_integer((T(form.middle[j]) - q) * T(1 / kTwoPi));
  return q + T(kTwoPi) * turns;
}
/// How far a joint value lies outside of its limits, 0 or less if it does not [rad].
template <typename T>
IKSEL_INLINE T beyond_limits(const ClosedForm& form, int j, const T& q) {
  return abs(q - T(form.middle[j])) - T(form.reach[j]);
}

/// Whether nothing more needs to be known of a branch, now that joint j is known: for Prospect
/// (sweep_kernel.hpp) and Certainty only.
template <typename T, typename Q>
IKSEL_INLINE bool is_enough(const ClosedForm& /*form*/, int /*j*/, Branch<T, Q>& /*branch*/) {
  return false;
}

template <typename T>
IKSEL_INLINE bool is_enough(const ClosedForm& form, int j, Branch<T, Certainty<T>>& branch) {
  const T q = joint_value(form, j, branch.q[j]);
  branch.quality.value[j] = q;
  branch.quality.take_beyond(beyond_limits(form, j, q));
  return branch.quality.is_over();
}

/// The angle of joint 3 that brings the wrist to a distance from the point on axis 2.
template <typename T, typename Q>
IKSEL_INLINE Angle<T> bend_elbow(const ClosedForm& form, const T& distance2, const T& sign,
                                 Q& quality) {
  return solve_angle(form.elbow, T(0.5) * (distance2 - T(form.arm2)), sign, quality);
}

/// From the point on axis 2 to the wrist, with joint 2 at zero.
template <typename T, typename Q>
IKSEL_INLINE Vec<T> arm_at(const ClosedForm& form, const Angle<T>& q3, Q& quality) {
  if constexpr (std::is_same_v<Q, Certainty<T>>) quality.turn_way(form.forearm);
  const Vec<T> forearm = turned(constant<T>(form.h[2]), q3, constant<T>(form.p[2]));
  return add(constant<T>(form.p[1]), T(1.0), forearm);
}

/// The angle of joint 1 with x . R_1^T w = rest.
template <typename T, typename Q>
IKSEL_INLINE Angle<T> turn_base(const ClosedForm& form, const Vec<T>& x, const Vec<T>& w,
                                const T& rest, const T& sign, Q& quality) {
  const Vec<T> h1 = constant<T>(form.h[0]);
  const T axial = dot(h1, x) * dot(h1, w);
  return solve_angle(dot(x, w) - axial, T(0.0) - dot(x, cross(h1, w)), rest - axial, sign, quality);
}

/// R_1^T w - p12
template <typename T>
IKSEL_INLINE Vec<T> behind_base(const ClosedForm& form, const Angle<T>& q1, const Vec<T>& w) {
  return add(turned_back(constant<T>(form.h[0]), q1, w), T(-1.0), constant<T>(form.p[0]));
}

// Joints 1 to 3, which bring the wrist to w, by how their axes lie.

template <typename T, typename Q>
IKSEL_INLINE void place_parallel_23(const ClosedForm& form, const Vec<T>& w, const T (&sign)[3],
                                    Branch<T, Q>& out) {
  // h2 . R_1^T w does not depend on joints 2 and 3.
  const Vec<T> h2 = constant<T>(form.h[1]);
  out.q[0] = turn_base(form, h2, w, T(form.rest), sign[0], out.quality);
  if (is_enough(form, 0, out)) return;
  const Vec<T> v = behind_base(form, out.q[0], w);
  out.q[2] = bend_elbow(form, dot(v, v), sign[1], out.quality);
  if (is_enough(form, 2, out)) return;
  out.q[1] = angle_between(h2, arm_at(form, out.q[2], out.quality), v, out.quality);
  is_enough(form, 1, out);
}

template <typename T, typename Q>
IKSEL_INLINE void place_intersect_12(const ClosedForm& form, const Vec<T>& w, const T (&sign)[3],
                                     Branch<T, Q>& out) {
  const Vec<T> h1 = constant<T>(form.h[0]);
  const Vec<T> h2 = constant<T>(form.h[1]);
  const T distance2 = dot(w, w);
  out.q[2] = bend_elbow(form, distance2, sign[1], out.quality);
  if (is_enough(form, 2, out)) return;
  const Vec<T> arm = arm_at(form, out.q[2], out.quality);
  const Vec<T> v =
      solve_common(h1, h2, form.cross12, dot(h1, w), dot(h2, arm), distance2, sign[0], out.quality);
  out.q[1] = angle_between(h2, arm, v, out.quality);
  if (is_enough(form, 1, out)) return;
  out.q[0] = angle_between(h1, v, w, out.quality);
  is_enough(form, 0, out);
}

template <typename T, typename Q>
IKSEL_INLINE void place_intersect_23(const ClosedForm& form, const Vec<T>& w, const T (&sign)[3],
                                     Branch<T, Q>& out) {
  // |R_1^T w - p12| does not depend on joints 2 and 3.
  const Vec<T> h2 = constant<T>(form.h[1]);
  const Vec<T> h3 = constant<T>(form.h[2]);
  const Vec<T> p34 = constant<T>(form.p[2]);
  out.q[0] = turn_base(form, constant<T>(form.p[0]), w, T(0.5) * (dot(w, w) - T(form.rest)),
                       sign[0], out.quality);
  if (is_enough(form, 0, out)) return;
  const Vec<T> v = behind_base(form, out.q[0], w);
  const Vec<T> u =
      solve_common(h2, h3, form.cross23, dot(h2, v), dot(h3, p34), dot(v, v), sign[1], out.quality);
  out.q[2] = angle_between(h3, p34, u, out.quality);
  if (is_enough(form, 2, out)) return;
  out.q[1] = angle_between(h2, u, v, out.quality);
  is_enough(form, 1, out);
}

template <typename T, typename Q>
IKSEL_INLINE void place_parallel_12(const ClosedForm& form, const Vec<T>& w, const T (&sign)[3],
                                    Branch<T, Q>& out) {
  const Vec<T> h1 = constant<T>(form.h[0]);
  const Vec<T> h2 = constant<T>(form.h[1]);
  const Vec<T> p12 = constant<T>(form.p[0]);
  out.q[2] = solve_angle(form.shoulder, dot(h1, w) - T(form.rest), sign[0], out.quality);
  if (is_enough(form, 2, out)) return;
  const Vec<T> arm = arm_at(form, out.q[2], out.quality);
  const T axial = dot(h2, arm) * dot(h2, p12);
  const T rest = T(0.5) * (dot(w, w) - dot(p12, p12) - dot(arm, arm));
  out.q[1] = solve_angle(dot(p12, arm) - axial, dot(p12, cross(h2, arm)), rest - axial, sign[1],
                         out.quality);
  if (is_enough(form, 1, out)) return;
  const Vec<T> from = add(p12, T(1.0), turned(h2, out.q[1], arm));
  out.q[0] = angle_between(h1, from, w, out.quality);
  is_enough(form, 0, out);
}

template <typename T, typename Q>
IKSEL_INLINE void place_wrist(const ClosedForm& form, const Vec<T>& w, const T (&sign)[3],
                              Branch<T, Q>& out) {
  switch (form.closure) {
    case Closure::parallel_23:
      return place_parallel_23(form, w, sign, out);
    case Closure::intersect_12:
      return place_intersect_12(form, w, sign, out);
    case Closure::intersect_23:
      return place_intersect_23(form, w, sign, out);
    case Closure::parallel_12:
      return place_parallel_12(form, w, sign, out);
    case Closure::three_parallel:
    case Closure::sweep_4:
    case Closure::sweep_6:
    case Closure::loop:
      return;
  }
}

/// (R_1 R_2 R_3)^T v
template <typename T, typename Q>
IKSEL_INLINE Vec<T> before_wrist(const ClosedForm& form, const Branch<T, Q>& branch,
                                 const Vec<T>& v) {
  const Vec<T> v1 = turned_back(constant<T>(form.h[0]), branch.q[0], v);
  const Vec<T> v2 = turned_back(constant<T>(form.h[1]), branch.q[1], v1);
  return turned_back(constant<T>(form.h[2]), branch.q[2], v2);
}

}  // namespace iksel::lanes
