// SPDX-License-Identifier: BSD-3-Clause
// Of many configurations always the one that lies farthest from those before.
#pragma once

#include <cstddef>
#include <vector>

#include "kinematics/joint_space.hpp"
#include "simd/lane_types.hpp"

namespace iksel {

/// Blocks whose seeds are iterated together, so that lanes find work.
inline constexpr int kBlocksAtOnce = 4;

/// Of `all` configurations, one after another in q [rad or m], the first, and then always the one
/// farthest from those before, by the joint that moves most; `count` of them at most, and none
/// nearer to another than `least`. In single precision: which of two that are equally far is taken
/// matters little.
std::vector<std::size_t> farthest_first(const JointSpace& joints, const double* q, std::size_t all,
                                        std::size_t count, double least = 0);

/// Seeds of some blocks that were not tried yet, the one farthest from every solution first: the
/// paper's farthest-first re-selection, with solutions found in the place of seeds that failed.
class FarthestFirstQueue {
 public:
  FarthestFirstQueue(const JointSpace& joints, const lanes::LaneKernels& kernels);

  /// The seeds of `blocks` packs in place of those before. The packs are the caller's.
  void reset(const lanes::SeedPack* packs, int blocks) {
    packs_ = packs;
    blocks_ = blocks;
    // The best of each block first, then the second best, and so on, where no distance decides.
    for (int block = 0; block < blocks; ++block) {
      for (int rank = 0; rank < lanes::kBlock; ++rank) {
        const int place = rank * blocks + block;
        nearest_[block * lanes::kBlock + packs[block].order[rank]] =
            kFar + kNext * static_cast<float>(kMost - place);
      }
    }
  }

  /// From now on seeds are taken by their distance from this solution too.
  void add_known(const double* solution) {
    float from[lanes::kMaxJoints];
    for (int j = 0; j < dof_; ++j) from[j] = static_cast<float>(solution[j]);
    kernels_.add_known(dof_, per_turn_, from, packs_->q[0], blocks_,
                       sizeof(lanes::SeedPack) / sizeof(float), nearest_);
  }

  /// Index of the next seed, -1 if none is left; and its distance from what it was to be kept from,
  /// in the joint where that is largest [rad or m]. Among those farther than kFar the order of the
  /// blocks decides.
  int pop(float& distance) {
    const int k = kernels_.find_largest(blocks_ * lanes::kBlock, nearest_);
    distance = nearest_[k];
    if (distance < 0) return -1;
    nearest_[k] = kTaken;
    return k;
  }

  [[nodiscard]] double q(int joint, int k) const {
    return static_cast<double>(packs_[k / lanes::kBlock].q[joint][k % lanes::kBlock]);
  }

 private:
  static constexpr int kMost = kBlocksAtOnce * lanes::kBlock;
  /// Farther than this makes no difference [rad or m]. With 0.3 and with 2, more seeds were
  /// needed for as many solutions.
  static constexpr float kFar = 1;
  /// Between one seed and the next in the order of the blocks.
  static constexpr float kNext = 1e-6F;
  static constexpr float kTaken = -1;

  int dof_;
  const lanes::LaneKernels& kernels_;
  const lanes::SeedPack* packs_ = nullptr;
  int blocks_ = 0;
  float per_turn_[lanes::kMaxJoints] = {};
  alignas(64) float nearest_[kMost] = {};
};

}  // namespace iksel
