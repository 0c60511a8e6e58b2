// SPDX-License-Identifier: BSD-3-Clause
// How far the joints move to branches of a chain of seven, and how far these are from being
// answers: a branch in each lane.
#pragma once

#include "simd/limit_kernel.hpp"

namespace iksel::lanes {

/// The least integer that is not below x.
template <typename T>
IKSEL_INLINE T round_up(const T& x) {
  const T n = nearest_integer(x);
  return select(n < x, n + T(1.0), n);
}

/// Adds to the moves, or to their squares' sum, that of one joint by d.
template <typename T>
IKSEL_INLINE void add_way(const MoveForm& form, int j, const T& d, T& sum) {
  const T way = abs(d) * T(form.weight[j]);
  sum = form.takes_largest ? max(sum, way) : sum + way * way;
}

/// What the lanes of a joint move by to its nearest image: to any, unless it has but one inside the
/// limits, and is inside.
template <typename T>
IKSEL_INLINE T loose_move(const MoveForm& form, int j, const T& q) {
  const T d = q - T(form.from[j]);
  if (!form.turns[j]) return abs(d);
  const T turns = nearest_integer(d * T(1 / kTwoPi));
  const T loose = abs(d - T(kTwoPi) * turns);
  if (form.has_images[j]) return loose;
  const T beyond = max(T(form.lower[j]) - q, q - T(form.upper[j]));
  return select(beyond > T(form.margin), loose, abs(d));
}

/// And to that nearest inside the limits.
template <typename T>
IKSEL_INLINE void add_inside_move(const MoveForm& form, int j, const T& q, T& inside) {
  const T d = q - T(form.from[j]);
  const T turns = form.turns[j] ? nearest_integer(d * T(1 / kTwoPi)) : T(0.0);
  T image = d;
  if (form.has_images[j]) {
    const T least = round_up((T(form.lower[j]) - q) * T(1 / kTwoPi));
    const T most = T(0.0) - round_up((q - T(form.upper[j])) * T(1 / kTwoPi));
    const T moved = d + T(kTwoPi) * min(max(T(0.0) - turns, least), most);
    // What is all but at a limit stays there.
    const T outside = max(T(form.lower[j]) - q, q - T(form.upper[j]));
    image = select(max(abs(turns), outside * T(0.25 / form.margin)) > T(0.5), moved, d);
  }
  if (!form.turns_in_sum[j]) add_way(form, j, image, inside);
}

/// Adds to `inside` what the joints whose images change limited sums move by: of these images,
/// together, the least move inside of the limits. As far as the margin they are outside.
template <typename T>
[[gnu::noinline]] void add_sums_move(const MoveForm& form, const T (&q)[7], T& inside) {
  const SumForm& sums = *form.sums;
  T least = T(1e30);
  T way = inside;
  for (int i = 0; i < sums.images; ++i) {
    T at[7];
    turn_to_image(sums, i, q, at);
    T sum = inside;
    for (int k = 0; k < sums.turning; ++k) {
      const int j = sums.joint[k];
      add_way(form, j, at[j] - T(form.from[j]), sum);
    }
    // Outside counts more than any move.
    const T outside = max(beyond_at(sums, at) + T(form.margin), T(0.0));
    const T cost = sum + select(outside > T(0.0), (outside + T(1.0)) * T(1e9), T(0.0));
    way = select(cost < least, sum, way);
    least = min(least, cost);
  }
  inside = way;
}

/// What six joints and the held one move by, inside the limits.
template <typename T>
IKSEL_INLINE T inside_move(const MoveForm& form, const T (&q)[7]) {
  T inside(0.0);
  for (int j = 0; j < 7; ++j) add_inside_move(form, j, q[j], inside);
  if (form.sums != nullptr) add_sums_move(form, q, inside);
  return inside;
}

/// Stores moves, or their squares' sums, and how far from an answer these lanes are.
template <typename T>
IKSEL_INLINE void store_moves(const MoveForm& form, const T& loose, const T& inside,
                              const T& beyond, const T& least, int first, MovePack& out) {
  Lanes<T>::store(form.takes_largest ? loose : sqrt(loose), out.loose + first);
  Lanes<T>::store(form.takes_largest ? inside : sqrt(inside), out.inside + first);
  Lanes<T>::store(max(beyond, T(0.0)) + sqrt(max(T(0.0) - least, T(0.0))), out.off + first);
}

/// To all lanes of a pack.
template <typename T>
void measure_moves(const MoveForm& form, const BranchPack& pack, MovePack& out) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    T q[7];
    for (int j = 0; j < 6; ++j) q[j] = Lanes<T>::load(pack.q[j] + first);
    q[6] = Lanes<T>::load(pack.held + first);
    T loose(0.0);
    for (int j = 0; j < 7; ++j) add_way(form, j, loose_move(form, j, q[j]), loose);
    store_moves(form, loose, inside_move(form, q), Lanes<T>::load(pack.beyond + first),
                Lanes<T>::load(pack.least + first), first, out);
  }
}

}  // namespace iksel::lanes
