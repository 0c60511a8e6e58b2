// SPDX-License-Identifier: BSD-3-Clause
// Six joints in closed form by subproblems (branch_math.hpp), a branch or a pose in each lane.
//
// With the axes h_j at zero angles, R_j = R(h_j, q_j) and p_j,j+1 the way between points on the
// axes: R_06 = R_1 ... R_6, and the way from the point on axis 1 to that on axis 6 is
// w = R_1 (p_12 + R_2 (p_23 + R_3 (p_34 + ...))). Where axes meet, their points are one.
#pragma once

#include "simd/branch_arm.hpp"
#include "simd/branch_swept.hpp"
#include "simd/limit_kernel.hpp"

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
  if constexpr (std::is_same_v<Q, Certainty<T>>) out.quality.turn_rotation();
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
  if (is_enough(form, 0, out)) return;
  const auto before = [&](const Vec<T>& v) { return turned_back(h1, out.q[0], v); };
  // h . R_1^T R_06 h6 = h . R_5 h6, and R_06^T R_1 h = R_6^T R_5^T h.
  const Vec<T> X = before(target.X);
  const Vec<T> Y = before(target.Y);
  const Vec<T> Z = before(target.Z);
  out.q[4] = solve_angle(form.wrist, dot(h, Z), sign[2], quality);
  if (is_enough(form, 4, out)) return;
  const Vec<T> from = turned_back(h5, out.q[4], h);
  const T u = dot(constant<T>(form.basis[0]), from);
  const T v = dot(constant<T>(form.basis[1]), from);
  const T x = dot(X, h);
  const T y = dot(Y, h);
  // Of (u, v) = R(q6) (x, y).
  out.q[5] = normalized(u * x + v * y, v * x - u * y, quality);
  if (is_enough(form, 5, out)) return;
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
  const Vec<T> ahead = add(add(scaled(r0, X), r1, Y), b2, Z);
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
  is_enough(form, 1, out);
  is_enough(form, 2, out);
  is_enough(form, 3, out);
}

/// Solves the two branches that differ in the last sign only, the two of `last`, or one, until
/// their quality, which begins as `quality`, is enough: take(i, branch).
template <typename T, typename Q, int kCount, typename Take>
IKSEL_INLINE void solve_signs(const ClosedForm& form, const BranchTarget<T>& target,
                              const T (&side)[2], const double (&last)[kCount], const Q& quality,
                              const Take& take) {
  Branch<T, Q> arm;
  arm.quality = quality;
  const bool has_wrist = form.closure != Closure::three_parallel;
  WristTarget<T> wrist;
  if (has_wrist) {
    place_wrist(form, target.w, {side[0], side[1], T(1.0)}, arm);
    if (arm.quality.is_over) {
      for (int i = 0; i < kCount; ++i) take(i, arm);
      return;
    }
    wrist = behind_arm(form, target, arm);
  }
  for (int i = 0; i < kCount; ++i) {
    Branch<T, Q> branch = arm;
    if (has_wrist) {
      turn_wrist(form, wrist, T(last[i]), branch);
    } else {
      solve_three_parallel(form, target, {side[0], side[1], T(last[i])}, branch);
    }
    take(i, branch);
  }
}

/// The joint values, and how far they are outside of their limits.
template <typename T, typename Q>
IKSEL_INLINE void store_branch(const ClosedForm& form, const Branch<T, Q>& branch, int first,
                               BranchPack& pack) {
  T beyond = T(0.0);
  T value[6];
  for (int j = 0; j < 6; ++j) {
    value[j] = joint_value(form, j, branch.q[j]);
    beyond = max(beyond, beyond_limits(form, j, value[j]));
    Lanes<T>::store(value[j], pack.q[j] + first);
  }
  const T held = Lanes<T>::load(pack.held + first);
  Lanes<T>::store(beyond_with_sums(form, beyond, value, held), pack.beyond + first);
  Lanes<T>::store(branch.quality.least, pack.least + first);
  Lanes<T>::store(branch.quality.error(form.error), pack.error + first);
}
template <typename T>
IKSEL_INLINE void store_branch(const ClosedForm& form, Branch<T, Certainty<T>>& branch, int first,
                               BranchPack& pack) {
  Certainty<T>& quality = branch.quality;
  if (!quality.is_over()) {
    for (int j = 0; j < 6; ++j) Lanes<T>::store(quality.value[j], pack.q[j] + first);
    if (form.sums != nullptr) {
      const T held = Lanes<T>::load(pack.held + first);
      quality.take_beyond(beyond_with_sums(form, T(-1e30), quality.value, held));
    }
  }
  Lanes<T>::store(max(quality.beyond, T(0.0)), pack.beyond + first);
  Lanes<T>::store(quality.least, pack.least + first);
  Lanes<T>::store(quality.best, pack.best + first);
  Lanes<T>::store(quality.worst, pack.worst + first);
  Lanes<T>::store(quality.error / quality.scale, pack.error + first);
  Lanes<T>::store(quality.outside, pack.outside + first);
}

template <typename T>
struct Signs {
  T of[3];

  IKSEL_INLINE Signs(const BranchPack& pack, int first)
      : of{Lanes<T>::load(pack.sign[0] + first), Lanes<T>::load(pack.sign[1] + first),
           Lanes<T>::load(pack.sign[2] + first)} {}
};

/// Joints 1 to 3 of a wrist's arm, and what is left to the wrist.
template <typename T>
struct PlacedArm {
  Branch<T, Certainty<T>> branch;
  WristTarget<T> wrist;
};

// Not inlined: whatever asks, the same code gives the same bits.

template <typename T>
[[gnu::noinline]] void place_arm(const ClosedForm& form, int first, const BranchPack& pack,
                                 PlacedArm<T>& arm) {
  const BranchTarget<T> target = load_target<T>(pack, first);
  place_wrist(form, target.w, Signs<T>(pack, first).of, arm.branch);
  if (!arm.branch.quality.is_over()) arm.wrist = behind_arm(form, target, arm.branch);
}

template <typename T>
[[gnu::noinline]] void finish_arm(const ClosedForm& form, const PlacedArm<T>& arm, int first,
                                  BranchPack& pack) {
  Branch<T, Certainty<T>> branch = arm.branch;
  if (!branch.quality.is_over()) {
    turn_wrist(form, arm.wrist, Signs<T>(pack, first).of[2], branch);
  }
  store_branch(form, branch, first, pack);
}

template <typename T>
[[gnu::noinline]] void solve_parallels(const ClosedForm& form, bool stops_outside, int first,
                                       BranchPack& pack) {
  Branch<T, Certainty<T>> branch{{}, Certainty<T>(form.error, stops_outside)};
  solve_three_parallel(form, load_target<T>(pack, first), Signs<T>(pack, first).of, branch);
  store_branch(form, branch, first, pack);
}

/// Of a form that is closed without a held joint, and how certain it is. With `kOfOneTarget`, of
/// all branches of it (all_branches()), as far as it takes to tell that they are not inside the
/// limits; branches with the same arm, half a pack apart, share it where they are in other lanes.
template <typename T, bool kOfOneTarget>
void solve_closed(const ClosedForm& form, BranchPack& pack) {
  using L = Lanes<T>;
  if (form.closure == Closure::three_parallel) {
    for (int first = 0; first < kWidth; first += L::kCount) {
      solve_parallels<T>(form, kOfOneTarget, first, pack);
    }
    return;
  }
  const bool share = kOfOneTarget && L::kCount <= kWidth / 2;
  for (int first = 0; first < (share ? kWidth / 2 : kWidth); first += L::kCount) {
    PlacedArm<T> arm{{{}, Certainty<T>(form.error, kOfOneTarget)}, {}};
    place_arm(form, first, pack, arm);
    finish_arm(form, arm, first, pack);
    if (share) finish_arm(form, arm, first + kWidth / 2, pack);
  }
}

/// Of any form, without `best` and `worst`; `error` is the least that it may be.
template <typename T>
void find_branches(const ClosedForm& form, BranchPack& pack) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    BranchTarget<T> target = load_target<T>(pack, first);
    const T held = Lanes<T>::load(pack.held + first);
    if (form.is_held) hold(form, held, target);
    const Signs<T> sign(pack, first);
    Branch<T, Definiteness<T>> branch;
    if (form.closure == Closure::three_parallel) {
      solve_three_parallel(form, target, sign.of, branch);
    } else if (form.closure == Closure::sweep_4 || form.closure == Closure::sweep_6) {
      T residual;
      solve_residual(form, target, held, sign.of, branch, residual);
      Lanes<T>::store(residual, pack.residual + first);
    } else {
      place_wrist(form, target.w, sign.of, branch);
      turn_wrist(form, behind_arm(form, target, branch), sign.of[2], branch);
    }
    store_branch(form, branch, first, pack);
  }
}

}  // namespace iksel::lanes
