// SPDX-License-Identifier: BSD-3-Clause
// Seeds of some tiles that were not tried yet, the one farthest from every solution first: the
// paper's farthest-first re-selection, with solutions found in the place of seeds that failed.
#pragma once

#include <algorithm>
#include <cmath>

#include "kinematics/chain_model.hpp"
#include "lanes/lane_types.hpp"
#include "math/constants.hpp"
#include "solver/joint_move.hpp"

namespace iksel {

/// Tiles whose seeds are iterated together, so that lanes find work.
inline constexpr int kTilesAtOnce = 4;

/// Memory is taken at construction, none later.
class SeedsLeft {
 public:
  explicit SeedsLeft(const ChainModel& model) : dof_(model.dof) {
    for (int j = 0; j < dof_; ++j) turn_[j] = has_whole_turns(model, j) ? kTwoPiFloat : 0;
  }

  /// The seeds of `tiles` packs in place of those before: the best of each, then the second best,
  /// and so on.
  void reset(const lanes::SeedPack* packs, int tiles) {
    count_ = tiles * lanes::kGroup;
    for (int k = 0; k < count_; ++k) {
      const lanes::SeedPack& pack = packs[k % tiles];
      const int slot = pack.order[k / tiles];
      for (int j = 0; j < dof_; ++j) q_[j][k] = pack.q[j][slot];
    }
    std::fill_n(nearest_, count_, kFar);
  }

  /// From now on seeds are taken by their distance from this solution too.
  void keep_from(const double* solution) {
    // Added to so large a number, a float loses what comes after its point: cheaper than to round.
    constexpr float kNoFraction = 12582912;
    float away[kMost] = {};
    for (int j = 0; j < dof_; ++j) {
      const auto at = static_cast<float>(solution[j]);
      const float turn = turn_[j];
      const float per_turn = turn > 0 ? 1 / turn : 0;
      for (int k = 0; k < count_; ++k) {
        const float d = q_[j][k] - at;
        const float turns = (d * per_turn + kNoFraction) - kNoFraction;
        away[k] = std::max(away[k], std::abs(d - turn * turns));
      }
    }
    for (int k = 0; k < count_; ++k) nearest_[k] = std::min(nearest_[k], away[k]);
  }

  /// The next seed, -1 if none is left; and its distance from what it was to be kept from, in the
  /// joint where that is largest [rad or m]. Among those farther than kFar the order of the tiles
  /// decides.
  int take(float& distance) {
    distance = farthest();
    if (distance < 0) return -1;
    const auto k = static_cast<int>(std::find(nearest_, nearest_ + count_, distance) - nearest_);
    nearest_[k] = kTaken;
    return k;
  }

  [[nodiscard]] double q(int joint, int k) const { return static_cast<double>(q_[joint][k]); }

 private:
  static constexpr int kMost = kTilesAtOnce * lanes::kGroup;
  static constexpr float kTwoPiFloat = static_cast<float>(kTwoPi);
  /// Farther than this makes no difference [rad or m]. With 0.3 and with 2, more seeds in vain were
  /// needed for as many solutions.
  static constexpr float kFar = 1;
  static constexpr float kTaken = -1;

  /// The largest of nearest_; some columns side by side, which the compiler makes SIMD of.
  [[nodiscard]] float farthest() const {
    constexpr int kColumns = 8;
    float most[kColumns];
    std::fill_n(most, kColumns, kTaken);
    for (int k = 0; k < count_; k += kColumns) {
      for (int i = 0; i < kColumns; ++i) most[i] = std::max(most[i], nearest_[k + i]);
    }
    return *std::max_element(most, most + kColumns);
  }

  int dof_;
  int count_ = 0;
  float turn_[lanes::kMaxJoints] = {};  ///< 0 for joints without whole turns
  alignas(64) float q_[lanes::kMaxJoints][kMost] = {};
  alignas(64) float nearest_[kMost] = {};
};

}  // namespace iksel
