// SPDX-License-Identifier: BSD-3-Clause
// How far the branches of a chain of seven are from being answers, at many values of its held joint
// at once: a value in each lane, one branch after the other. Most branches are far from it over
// wide ranges of that joint, and are left as soon as all lanes are.
#pragma once

#include "simd/branch_kernel.hpp"

namespace iksel::lanes {

/// Angles that follow from a quotient by less may be any.
inline constexpr double kAnyAngle = 1e-6;
/// Beside such a place they change as fast as the root of what they are divided by is small: how
/// far they lie beyond limits counts no more than so many times that, and so falls towards it.
inline constexpr double kSteepness = 3;

/// Whether a branch may be near to an answer, by the angles found so far.
template <typename T>
struct Prospect {
  double bound;
  T least = T(1.0);
  T beyond = T(0.0);
  /// What angles so far follow from quotients by: where it is all but nothing, as where a straight
  /// arm turns, they may be any, and limits say nothing about what follows.
  T divisor = T(1.0);
  /// No lane's branch is.
  bool is_over = false;

  IKSEL_INLINE void divide_by_product(const T& product) { divisor = min(divisor, product); }
  IKSEL_INLINE void take_root(const T& square, const T& /*near*/, const T& /*root*/) {
    least = min(least, square);
  }
  /// How far it is from being an answer, at least.
  [[nodiscard]] IKSEL_INLINE T off() const { return beyond + sqrt(max(T(0.0) - least, T(0.0))); }
  /// Not below 0 where off() may be within the bound, without its root.
  [[nodiscard]] IKSEL_INLINE T room() const {
    return min(T(bound) - beyond, least + T(bound * bound));
  }
  /// How far the joint whose angle is known now may be away from something, limits or where it was,
  /// and still count as that far.
  [[nodiscard]] IKSEL_INLINE T most_that_counts() const {
    const T all(1e30);
    const auto changes = divisor < T(1 / (kSteepness * kSteepness));
    if (!any(changes)) return all;
    const T steep = T(kSteepness) * sqrt(max(divisor, T(0.0)));
    return select(changes, select(divisor < T(kAnyAngle), T(0.0), steep), all);
  }
  /// Whether it may be in some lane.
  [[nodiscard]] IKSEL_INLINE bool is_open() const { return any(room() >= T(0.0)); }
};

/// How far an angle lies outside of limits, 0 or less if it does not: by the sine of that, and from
/// a right angle on by 1. It takes no arc, only the cosine and the sine of the difference between
/// the angle's distance to the middle and what is within reach.
template <typename T>
IKSEL_INLINE T sine_beyond(const LimitArc& arc, const Angle<T>& t) {
  const T c = t.c * T(arc.middle_c) + t.s * T(arc.middle_s);
  const T s = abs(t.s * T(arc.middle_c) - t.c * T(arc.middle_s));
  const T sine = s * T(arc.reach_c) - c * T(arc.reach_s);
  const T cosine = c * T(arc.reach_c) + s * T(arc.reach_s);
  return select(cosine < T(0.0), select(sine > T(0.0), T(1.0), sine), sine);
}

template <typename T>
IKSEL_INLINE bool is_enough(const ClosedForm& form, int j, Branch<T, Prospect<T>>& branch) {
  Prospect<T>& prospect = branch.quality;
  const LimitArc& arc = form.arc[j];
  if (arc.ends) {
    const T sine = sine_beyond(arc, branch.q[j]);
    prospect.beyond = max(prospect.beyond, min(sine, prospect.most_that_counts()));
  }
  prospect.is_over = !prospect.is_open();
  return prospect.is_over;
}

template <typename T>
using RatedBranch = Branch<T, Prospect<T>>;

/// Adds to how far a branch is off what sums of its joints are beyond their limits.
template <typename T>
IKSEL_INLINE void add_sums(const ClosedForm& form, const T& held, RatedBranch<T>& branch) {
  if (form.sums == nullptr || branch.quality.is_over) return;
  T q[6];
  for (int j = 0; j < 6; ++j) q[j] = joint_value(form, j, branch.q[j]);
  branch.quality.beyond = beyond_with_sums(form, branch.quality.beyond, q, held);
}

/// The target at the held joint's values in the lanes from `first` on.
template <typename T>
IKSEL_INLINE BranchTarget<T> held_target(const ClosedForm& form, const BranchPack& pack, int first,
                                         const T& held) {
  BranchTarget<T> target = load_target<T>(pack, first);
  hold(form, held, target);
  return target;
}

/// How far the branches of so many arms are off, of both signs of the wrist, which are half a pack
/// apart, or of one.
template <int kWrists, typename T>
IKSEL_INLINE void rate_arms(const ClosedForm& form, const BranchPack& pack, double bound, int arms,
                            double (*off)[kWidth]) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    const T held = Lanes<T>::load(pack.held + first);
    const BranchTarget<T> target = held_target(form, pack, first, held);
    Prospect<T> prospect;
    prospect.bound = bound;
    for (int arm = 0; arm < arms; ++arm) {
      double last[kWrists];
      for (int i = 0; i < kWrists; ++i) last[i] = pack.sign[2][arm + i * arms];
      solve_signs(
          form, target, {T(pack.sign[0][arm]), T(pack.sign[1][arm])}, last,
          prospect, [&](int i, RatedBranch<T>& branch) __attribute__((always_inline)) {
            add_sums(form, held, branch);
            Lanes<T>::store(branch.quality.off(), off[arm + i * arms] + first);
          });
    }
  }
}

/// At kWidth angles of the held joint: off[branch][angle] is how far a branch, of the signs in the
/// pack's lanes, is from being an answer, as SweptBranches::off but for the sine of sine_beyond();
/// where that is more than `bound`, some number above it.
template <typename T>
void rate_branches(const ClosedForm& form, const BranchPack& pack, double bound,
                   double (&off)[kWidth][kWidth]) {
  rate_arms<2, T>(form, pack, bound, kWidth / 2, off);
}

/// The same of one branch, whose signs are in the pack's first lane.
template <typename T>
void rate_branch(const ClosedForm& form, const BranchPack& pack, double bound,
                 double (&off)[kWidth]) {
  rate_arms<1, T>(form, pack, bound, 1, &off);
}

}  // namespace iksel::lanes
