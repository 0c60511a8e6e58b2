// SPDX-License-Identifier: BSD-3-Clause
// One target asked of a reduced database, and the memory that its seeds for the lanes need.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/rotation.hpp"
#include "database/data.hpp"
#include "database/key.hpp"
#include "goal/goal.hpp"
#include "kinematics/chain_model.hpp"
#include "seeds/farthest_first.hpp"
#include "simd/kernels.hpp"

namespace iksel {

/// Starts a lane at the seed of that rank.
template <typename Refiner>
void load_ranked(const lanes::SeedPack& seeds, int rank, Refiner& refiner, int lane) {
  const int entry = seeds.order[rank];
  refiner.load(lane, [&](int j) { return static_cast<double>(seeds.q[j][entry]); });
}

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

  /// The samples of the leaf that the target falls into, as seeds.
  void prepare_leaf(lanes::SeedPack& seeds) const { prepare(data_.leaves.block(key_), seeds); }

  /// The blocks of samples, nearest first: to come before prepare_blocks. Returns how many there
  /// are.
  std::size_t measure_blocks();
  /// Of those, how many the neighbours that are asked for fill.
  [[nodiscard]] std::size_t near_blocks() const { return near_blocks_; }
  /// Those with the ranks `first` to `first` + count - 1, which have to be asked for in turn, each
  /// with its seeds in packs[i].
  void prepare_blocks(std::size_t first, std::size_t count, lanes::SeedPack* packs);

  /// For AllowedSeeds: a leaf, and then the nearest block of samples that was not taken yet.
  static constexpr int kPerPose = lanes::kBlock;
  bool find_first(const Goal& goal);
  bool find_next(const Goal& goal, const Pose& allowed);
  template <typename Refiner>
  void load_found(int rank, Refiner& refiner, int lane) const {
    load_ranked(packs[0], rank, refiner, lane);
  }

  /// Where sources keep their seeds.
  lanes::SeedPack packs[kBlocksAtOnce] = {};
  FarthestFirstQueue queue;

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
  std::vector<float> block_distance2_;
  std::vector<std::uint64_t> block_order_;  ///< squared distance, and the block
  std::vector<bool> is_tried_;              ///< of each block
};

}  // namespace iksel
