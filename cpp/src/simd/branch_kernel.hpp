// SPDX-License-Identifier: BSD-3-Clause
// Six joints in closed form by subproblems (branch_math.hpp), a branch or a pose in each lane.
//
// With the axes h_j at zero angles, R_j = R(h_j, q_j) and p_j,j+1 the way between points on the
// axes: R_06 = R_1 ... R_6, and the way from the point on axis 1 to that on axis 6 is
// w = R_1 (p_12 + R_2 (p_23 + R_3 (p_34 + ...))). Where axes meet, their points are one.
#pragma once

#include "simd/branch_arm.hpp"
#include "simd/branch_swept.hpp"
#include "simd/coupled_kernel.hpp"

namespace iksel::lanes {

/// What of a target is left to the wrist, whose axes meet: R_4 R_5 R_6 takes h6 to `axis`, and the
/// first of the basis to `side`.
template <typename T>
struct WristTarget {
  Vec<T> axis, side;
};

template <typename T, typename Q>
IKSEL_INLINE WristTarget<T> behind_arm(const ClosedForm& form, const BranchTarget<T>& target,
                                       const Branch<T, Q>& arm) {
  return {before_wrist(form, arm, target.Z), before_wrist(form, arm, target.X)};
}

/// Joints 4 to 6, after joints 1 to 3.
template <typename T, typename Q>
IKSEL_INLINE void turn_wrist(const ClosedForm& form, const WristTarget<T>& target, const T& sign,
                             Branch<T, Q>& out) {
  const Vec<T> h4 = constant<T>(form.h[3]);
  const Vec<T> h5 = constant<T>(form.h[4]);
  const Vec<T> h6 = constant<T>(form.h[5]);
  out.q[4] = solve_angle(form.wrist, dot(h4, target.axis), sign, out.quality);
  if (is_enough(form, 4, out)) return;
  out.q[3] = angle_between(h4, turned(h5, out.q[4], h6), target.axis, out.quality);
  if (is_enough(form, 3, out)) return;
  const Vec<T> rest = turned_back(h5, out.q[4], turned_back(h4, out.q[3], target.side));
  out.q[5] = {dot(constant<T>(form.basis[0]), rest), dot(constant<T>(form.basis[1]), rest)};
  is_enough(form, 5, out);
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
  out.q[0] = turn_base(form, h, w, T(form.rest), sign[0], quality);
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
  const Vec<T> reach =
      add(behind_base(form, out.q[0], w), T(-1.0), turned(h, all, constant<T>(form.p[3])));
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

/// How far the joint values that are stored lie outside of coupled limits.
template <typename T>
T beyond_coupled(const ClosedForm& form, int first, const BranchPack& pack) {
  T q[7];
  for (int j = 0; j < 6; ++j) q[j] = Lanes<T>::load(pack.q[j] + first);
  q[6] = form.is_held ? Lanes<T>::load(pack.held + first) : T(0.0);
  return beyond_coupled(*form.coupled, q);
}

/// The joint values, and how far they are outside of their limits.
template <typename T, typename Q>
IKSEL_INLINE void store_joints(const ClosedForm& form, const Branch<T, Q>& branch, int first,
                               BranchPack& pack) {
  T beyond = T(0.0);
  for (int j = 0; j < 6; ++j) {
    const T q = joint_value(form, j, branch.q[j]);
    beyond = max(beyond, beyond_limits(form, j, q));
    Lanes<T>::store(q, pack.q[j] + first);
  }
  if (form.coupled != nullptr) beyond = max(beyond, beyond_coupled<T>(form, first, pack));
  Lanes<T>::store(beyond, pack.beyond + first);
  Lanes<T>::store(branch.quality.least, pack.least + first);
}

/// The lanes from `first` on.
template <typename T, typename Q>
IKSEL_INLINE Branch<T, Q> solve_branch(const ClosedForm& form, int first, Q quality,
                                       BranchPack& pack) {
  BranchTarget<T> target = load_target<T>(pack, first);
  const T held = Lanes<T>::load(pack.held + first);
  if (form.is_held) hold(form, held, target);
  const T sign[3] = {Lanes<T>::load(pack.sign[0] + first), Lanes<T>::load(pack.sign[1] + first),
                     Lanes<T>::load(pack.sign[2] + first)};
  Branch<T, Q> branch;
  branch.quality = quality;
  if (form.closure == Closure::three_parallel) {
    solve_three_parallel(form, target, sign, branch);
  } else if (form.closure == Closure::sweep_4 || form.closure == Closure::sweep_6) {
    solve_sweep(form, target, held, sign, branch, pack.residual + first);
  } else {
    place_wrist(form, target.w, sign, branch);
    turn_wrist(form, behind_arm(form, target, branch), sign[2], branch);
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

/// Of any form, without `best` and `worst`; `error` is the least that it may be.
template <typename T>
void find_branches(const ClosedForm& form, BranchPack& pack) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    const Definiteness<T> quality = solve_branch<T>(form, first, Definiteness<T>{}, pack).quality;
    Lanes<T>::store(quality.error(form.error), pack.error + first);
  }
}

}  // namespace iksel::lanes
