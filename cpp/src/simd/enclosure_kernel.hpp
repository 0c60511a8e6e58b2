// SPDX-License-Identifier: BSD-3-Clause
// Branches in closed form over ranges of a joint, a range in each lane: whether there are any
// inside the limits, for any target within an error.
#pragma once

#include "base/constants.hpp"
#include "simd/branch_kernel.hpp"
#include "simd/enclosed.hpp"

namespace iksel::lanes {

/// Where an enclosed branch may still be inside the limits.
template <typename T>
struct Presence {
  /// Below 0: there is no such branch; or it is certainly outside.
  T room = T(1.0);
  /// No lane's may be inside.
  bool is_over = false;

  IKSEL_INLINE void take_root(const Enclosed<T>& square, const Enclosed<T>& /*near*/,
                              const Enclosed<T>& /*root*/) {
    take(square.upper());
  }
  IKSEL_INLINE void take(const T& of_condition) {
    // Not where it is no number.
    room = select(of_condition < T(0.0), of_condition, room);
    is_over = !any(room >= T(0.0));
  }
};

template <typename T>
using EnclosedBranch = Branch<Enclosed<T>, Presence<T>>;

/// How far an enclosed angle may still be within limits; below 0: it is certainly not [rad].
template <typename T>
IKSEL_INLINE T room_within(const ClosedForm& form, int j, const Angle<Enclosed<T>>& angle) {
  const T size =
      sqrt(max(angle.c.value() * angle.c.value() + angle.s.value() * angle.s.value(), T(1e-12)));
  const T inverse = T(1.0) / size;
  const T c = angle.c.reach();
  const T s = angle.s.reach();
  // Seen from the origin, a point is off by no more than the arc sine of how far it is away: of s
  // up to 0.7 no more than s (1 + 0.3 s^2).
  const T sine = sqrt(c * c + s * s) * inverse;
  const T off = sine * (T(1.0) + T(0.3) * sine * sine) + T(kRounding);
  const T q = joint_value(form, j, Angle<T>{angle.c.value() * inverse, angle.s.value() * inverse});
  return select(sine < T(0.7), off - beyond_limits(form, j, q), T(1.0));
}

template <typename T>
IKSEL_INLINE bool is_enough(const ClosedForm& form, int j, EnclosedBranch<T>& branch) {
  branch.quality.take(room_within(form, j, branch.q[j]));
  return branch.quality.is_over;
}

/// A target that is the same in all lanes, but for an error.
template <typename T>
IKSEL_INLINE BranchTarget<Enclosed<T>> enclosed_target(const ClosedForm& form,
                                                       const BranchPack& pack) {
  const T error(form.error);
  const Vec<T> none{T(0.0), T(0.0), T(0.0)};
  const auto row = [&](int i) { return T(pack.target[i][0]); };
  const auto vector = [&](int i) {
    return Vec<Enclosed<T>>(Vec<T>{row(i), row(i + 1), row(i + 2)}, none, {error, error, error},
                            error, error);
  };
  return {vector(0), vector(3), vector(6), vector(9)};
}

/// What may be of the branches of two signs, and of the third of both kinds.
template <typename T>
IKSEL_INLINE void enclose_signs(const ClosedForm& form, const BranchTarget<Enclosed<T>>& target,
                                const Enclosed<T>& held, const Enclosed<T> (&side)[2],
                                T (&room)[2]) {
  if (form.closure == Closure::sweep_4 || form.closure == Closure::sweep_6) {
    EnclosedBranch<T> branch;
    Enclosed<T> residual;
    solve_residual(form, target, held, {side[0], side[1], Enclosed<T>(1.0)}, branch, residual);
    if (!branch.quality.is_over) {
      branch.quality.take(residual.reach() - abs(residual.value()));
      for (int j = 3; j < 6; ++j) is_enough(form, j, branch);  // the held one once more
    }
    room[0] = branch.quality.room;
    room[1] = T(-1.0);
    return;
  }
  solve_signs(form, target, side, {1.0, -1.0}, Presence<T>(),
              [&](int i, const EnclosedBranch<T>& branch) { room[i] = branch.quality.room; });
}

/// Ranges of the held joint, pack.held +- half; `room` below 0 where no branch of a lane's first
/// two signs is inside the limits anywhere in its range, for any target within the form's error;
/// for each third sign.
template <typename T>
void enclose_branches(const ClosedForm& form, const BranchPack& pack, double half,
                      double (&room)[2][kWidth]) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    const Enclosed<T> held(Lanes<T>::load(pack.held + first), T(half), T(0.0));
    BranchTarget<Enclosed<T>> target = enclosed_target<T>(form, pack);
    if (form.is_held) hold(form, held, target);
    const auto sign = [&](int i) {
      return Enclosed<T>(Lanes<T>::load(pack.sign[i] + first), T(0.0), T(0.0));
    };
    T of[2];
    enclose_signs(form, target, held, {sign(0), sign(1)}, of);
    for (int i = 0; i < 2; ++i) Lanes<T>::store(of[i], room[i] + first);
  }
}

}  // namespace iksel::lanes
