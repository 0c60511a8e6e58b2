// SPDX-License-Identifier: BSD-3-Clause
// How far the branches of a chain of seven are from being answers, at many values of its held joint
// at once: a value in each lane, one branch after the other. Most branches are far from it over
// wide ranges of that joint, and are left as soon as all lanes are.
#pragma once

#include "simd/branch_kernel.hpp"

namespace iksel::lanes {

/// Whether a branch may be near to an answer, by the angles found so far.
template <typename T>
struct Prospect {
  T bound;
  T least = T(1.0);
  T beyond = T(0.0);
  /// No lane's branch is.
  bool is_over = false;

  IKSEL_INLINE void divide_by_product(const T& /*product*/) {}
  IKSEL_INLINE void take_root(const T& square, const T& /*near*/, const T& /*root*/) {
    least = min(least, square);
  }
  /// How far it is from being an answer, at least.
  [[nodiscard]] IKSEL_INLINE T off() const { return beyond + sqrt(max(T(0.0) - least, T(0.0))); }
};

template <typename T>
IKSEL_INLINE bool is_enough(const ClosedForm& form, int j, Branch<T, Prospect<T>>& branch) {
  Prospect<T>& prospect = branch.quality;
  const T q = joint_value(form, j, branch.q[j]);
  prospect.beyond = max(prospect.beyond, beyond_limits(form, j, q));
  prospect.is_over = !any(prospect.off() <= prospect.bound);
  return prospect.is_over;
}

/// The branches that differ in the last sign only, from one that has the others.
template <typename T>
IKSEL_INLINE void rate_pair(const ClosedForm& form, const BranchTarget<T>& target,
                            const BranchPack& pack, int first, int lane, double bound,
                            double (&off)[kWidth][kWidth]) {
  const int other = lane + kWidth / 2;
  const bool has_wrist = form.closure != Closure::three_parallel;
  Branch<T, Prospect<T>> arm;
  arm.quality.bound = T(bound);
  const T side[2] = {T(pack.sign[0][lane]), T(pack.sign[1][lane])};
  if (has_wrist) place_wrist(form, target.w, {side[0], side[1], T(1.0)}, arm);
  if (arm.quality.is_over) {
    Lanes<T>::store(arm.quality.off(), off[lane] + first);
    Lanes<T>::store(arm.quality.off(), off[other] + first);
    return;
  }
  for (const int each : {lane, other}) {
    Branch<T, Prospect<T>> branch = arm;
    const T last = T(pack.sign[2][each]);
    if (has_wrist) {
      turn_wrist(form, target, last, branch);
    } else {
      solve_three_parallel(form, target, {side[0], side[1], last}, branch);
    }
    for (int j = has_wrist ? 3 : 0; j < 6; ++j) is_enough(form, j, branch);
    if (form.coupled != nullptr) {
      T q[7];
      for (int j = 0; j < 6; ++j) q[j] = joint_value(form, j, branch.q[j]);
      q[6] = Lanes<T>::load(pack.held + first);
      branch.quality.beyond = max(branch.quality.beyond, beyond_coupled(*form.coupled, q));
    }
    Lanes<T>::store(branch.quality.off(), off[each] + first);
  }
}

/// At kWidth angles of the held joint: off[branch][angle] is how far a branch, of the signs in the
/// pack's lanes, is from being an answer, as SweptBranches::off; where that is more than `bound`,
/// some number above it.
template <typename T>
void rate_branches(const ClosedForm& form, const BranchPack& pack, double bound,
                   double (&off)[kWidth][kWidth]) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    const auto vector = [&](int i) {
      const auto row = [&](int r) { return Lanes<T>::load(pack.target[r] + first); };
      return Vec<T>{row(i), row(i + 1), row(i + 2)};
    };
    BranchTarget<T> target{vector(0), vector(3), vector(6), vector(9)};
    hold(form, Lanes<T>::load(pack.held + first), target);
    for (int lane = 0; lane < kWidth / 2; ++lane) {
      rate_pair(form, target, pack, first, lane, bound, off);
    }
  }
}

}  // namespace iksel::lanes
