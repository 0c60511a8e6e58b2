// SPDX-License-Identifier: BSD-3-Clause
// One target asked of a reduced database: a cursor over its samples, and the memory that their
// seeds for the lanes need.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/rotation.hpp"
#include "database/data.hpp"
#include "database/key.hpp"
#include "goal/goal.hpp"
#include "kinematics/chain_model.hpp"
#include "simd/kernels.hpp"

namespace iksel {

/// Blocks whose seeds are iterated together, so that lanes find work.
inline constexpr int kBlocksAtOnce = 4;

class LaneQuery {
 public:
  /// `nominal` is the chain that the data belongs to; `model` may differ from it a little. Of the
  /// database that many `neighbours` are asked for at most.
  LaneQuery(const ChainModel& model, const ChainModel& nominal, const DatabaseData& data,
            int neighbours, const lanes::LaneKernels& kernels);

  /// Y (reduction.hpp).
  [[nodiscard]] Pose reduce(const Pose& T_base_tcp) const {
    return compose(compose(base_inverse_, T_base_tcp), tcp_inverse_);
  }
  /// What seeds are asked for from now on.
  void set_target(const Pose& Y);

  /// The samples of the leaf that the target falls into, as the seeds of packs[0].
  void prepare_leaf() { prepare(data_.leaves.block(key_), packs[0]); }

  /// Goes before all blocks of samples, the nearest first.
  void begin_blocks();
  /// The next blocks, at most `most`, as the seeds of packs[0] and following. Returns how many.
  std::size_t next_blocks(std::size_t most);
  /// Blocks that were given, and how many the neighbours that are asked for fill.
  [[nodiscard]] std::size_t blocks_given() const { return blocks_given_; }
  [[nodiscard]] std::size_t near_blocks() const { return near_blocks_; }

  /// For AllowedSeeds: a leaf, and then the nearest block of samples that was not taken yet.
  static constexpr int kPerPose = lanes::kBlock;
  bool find(const Goal& goal, const Pose& allowed, bool is_first);
  /// Starts a lane at the seed of a pack of that rank.
  template <typename Refiner>
  void load(int rank, Refiner& refiner, int lane, int pack = 0) const {
    const lanes::SeedPack& seeds = packs[pack];
    const int entry = seeds.order[rank];
    refiner.load(lane, [&](int j) { return static_cast<double>(seeds.q[j][entry]); });
  }

  /// The seeds.
  lanes::SeedPack packs[kBlocksAtOnce] = {};

 private:
  void prepare(const float* block, lanes::SeedPack& seeds) const {
    kernels_.prepare(seed_chain_, seed_target_, block, seeds);
  }

  const DatabaseData& data_;
  const lanes::LaneKernels& kernels_;
  Pose base_inverse_, tcp_inverse_;  ///< Y = base_inverse T_base_tcp tcp_inverse
  lanes::SeedChain seed_chain_;
  lanes::SeedTarget seed_target_{};
  double key_[kMaxKeyDimension] = {};
  std::size_t near_blocks_;
  std::size_t blocks_given_ = 0;
  std::vector<float> block_distance2_;
  std::vector<std::uint64_t> block_order_;  ///< squared distance, and the block
  std::vector<bool> is_tried_;              ///< of each block
};

}  // namespace iksel
