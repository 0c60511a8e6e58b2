// SPDX-License-Identifier: BSD-3-Clause
// How far the joints of a chain of seven move to its branches, at many values of its held joint at
// once: a value in each lane, one branch after the other. Branches are left as soon as all lanes
// are known to be too far away.
#pragma once

#include "simd/move_kernel.hpp"
#include "simd/sweep_kernel.hpp"

namespace iksel::lanes {

/// As kSteepness, but of what angles are divided by itself: from one sample to the next they turn
/// far before its root is small. Measured by `python -m bench moves`.
inline constexpr double kSwingSteepness = 36;

/// Whether a branch may be near to an answer that is not far away, by the joints found so far.
template <typename T>
struct NearProspect : Prospect<T> {
  const MoveForm* move;
  /// Of the moves, or of their squares' sum.
  double most;
  /// By what the joints move, or the sum of the squares of that.
  T loose;
  T q[6] = {T(kUnknown), T(kUnknown), T(kUnknown), T(kUnknown), T(kUnknown), T(kUnknown)};
  /// As BranchRow has them, of these lanes.
  std::uint64_t below = 0, above = 0;

  [[nodiscard]] IKSEL_INLINE T most_that_counts() const {
    const T all(1e30);
    const auto changes = this->divisor < T(1 / kSwingSteepness);
    return any(changes) ? select(changes, T(kSwingSteepness) * this->divisor, all) : all;
  }
  [[nodiscard]] IKSEL_INLINE bool is_open() const {
    return any(min(this->room(), T(most) - loose) >= T(0.0));
  }
};

template <typename T>
IKSEL_INLINE bool is_enough(const ClosedForm& form, int j, Branch<T, NearProspect<T>>& branch) {
  NearProspect<T>& prospect = branch.quality;
  const T q = joint_value(form, j, branch.q[j]);
  prospect.q[j] = q;
  const T most = prospect.most_that_counts();
  add_way(*prospect.move, j, min(loose_move(*prospect.move, j, q), most), prospect.loose);
  const T past = min(beyond_limits(form, j, q), most);
  prospect.beyond = max(prospect.beyond, past);
  if (const std::uint64_t far = to_bits<T>(past > T(prospect.bound)); far != 0) {
    const std::uint64_t above = far & to_bits<T>(q > T(form.middle[j]));
    prospect.above |= above << (kWidth * j);
    prospect.below |= (far & ~above) << (kWidth * j);
  }
  prospect.is_over = !prospect.is_open();
  return prospect.is_over;
}

/// At kWidth values of the held joint, in the pack, of the branches with the signs in its lanes.
template <typename T>
void measure_branches(const ClosedForm& form, const MoveForm& move, const BranchPack& pack,
                      double bound, double most, BranchRow (&rows)[kWidth]) {
  for (int first = 0; first < kWidth; first += Lanes<T>::kCount) {
    const T held = Lanes<T>::load(pack.held + first);
    const BranchTarget<T> target = held_target(form, pack, first, held);
    NearProspect<T> prospect;
    prospect.move = &move;
    prospect.bound = bound;
    prospect.most = move.takes_largest ? most : most * most;
    prospect.loose = T(0.0);
    add_way(move, 6, loose_move(move, 6, held), prospect.loose);
    for (int lane = 0; lane < kWidth / 2; ++lane) {
      const int other = lane + kWidth / 2;
      const auto take = [&](int i, const Branch<T, NearProspect<T>>& branch)
          __attribute__((always_inline)) {
        const NearProspect<T>& found = branch.quality;
        BranchRow& row = rows[i == 0 ? lane : other];
        const std::uint64_t within = to_bits<T>(found.loose <= T(found.most));
        row.within = (first == 0 ? 0 : row.within) | within << first;
        row.below = (first == 0 ? 0 : row.below) | found.below << first;
        row.above = (first == 0 ? 0 : row.above) | found.above << first;
        T q[7];
        for (int j = 0; j < 6; ++j) {
          q[j] = found.q[j];
          Lanes<T>::store(q[j], row.q[j] + first);
        }
        q[6] = held;
        T beyond = found.beyond;
        T inside(kFarAway * kFarAway);
        if (!found.is_over) {
          beyond = beyond_with_sums(form, beyond, found.q, held);
          inside = inside_move(move, q);
        }
        Lanes<T>::store(found.least, row.least + first);
        store_moves(move, found.loose, inside, beyond, found.least, first, row.moves);
      };
      solve_signs(form, target, {T(pack.sign[0][lane]), T(pack.sign[1][lane])},
                  {pack.sign[2][lane], pack.sign[2][other]}, prospect, take);
    }
  }
}

}  // namespace iksel::lanes
