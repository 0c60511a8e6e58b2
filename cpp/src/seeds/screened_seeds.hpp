// SPDX-License-Identifier: BSD-3-Clause
// The whole database as seeds, the samples near the target first, and seeds at random. Most of them
// fail, and of a target without an answer all: so each is first iterated in single precision,
// and only those that have come near are handed on.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/random.hpp"
#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"
#include "seeds/lane_query.hpp"
#include "seeds/row_seeds.hpp"
#include "simd/kernels.hpp"
#include "simd/lane_chain.hpp"

namespace iksel {

/// Rough iterations of seeds, many abreast.
class SeedScreen {
 public:
  SeedScreen(const ChainModel& model, const SolverOptions& options,
             const lanes::LaneKernels& kernels);

  /// Before seeds for Y (reduction.hpp).
  void begin(const Pose& Y);
  [[nodiscard]] bool is_full() const { return filled_ == lanes::kBlock; }
  /// Takes a seed: value(joint), inside the limits.
  template <typename Value>
  void add(const Value& value) {
    for (int j = 0; j < chain_.n; ++j) {
      pack_.q[j][filled_] = chain_.to_lane(j, static_cast<float>(value(j)));
    }
    ++filled_;
  }
  /// Iterates what was added, and empties the places for more: adds the joint values of those that
  /// came near to rows from `count` on. Returns the iterations.
  int run(double (*rows)[lanes::kMaxJoints], std::size_t& count);

 private:
  /// What few seeds that fail come down to, and most that do not: squared error [rad and units].
  static constexpr float kNear2 = 1e-3F;
  static constexpr int kIterations = 7;

  double per_metre_;  ///< of the unit of all lengths that lanes work on
  lanes::LaneChainOf<float> chain_;
  lanes::LaneOptions options_{};
  const lanes::LaneKernels& kernels_;
  int iterations_;
  lanes::RoughPack pack_{};
  int filled_ = 0;
};

class ScreenedSeeds : public RowSeeds {
 public:
  /// Seeds of both kinds count as attempts when they are screened.
  ScreenedSeeds(LaneQuery& query, SeedScreen& screen, const Pose& Y, const JointSpace& joints,
                std::uint64_t seed, Work& work);

  /// Screens some.
  bool next_stage();

 private:
  /// Packs of a stage: what is near of these fills the lanes. The last is at random, should the
  /// database's samples lead nowhere: of 50 million reachable targets of arms that are searched 27
  /// had been lost, with none but after the whole database, and 7 are, all of one arm (python -m
  /// bench lost --random 250 --targets 100000 --seed 424242000 --builds right_angles_6
  /// right_angles_7).
  static constexpr int kPacks = 4;

  void screen_one_pack(bool is_random);
  /// Goes on to the next block; false if there are no more.
  bool take_block();

  LaneQuery& query_;
  SeedScreen& screen_;
  const JointSpace& joints_;
  Random random_;
  const lanes::SeedPack* block_ = nullptr;
  std::size_t left_ = 0;  ///< blocks that the query has made seeds of
  int rank_ = 0;          ///< of the next seed in the block
  int last_rank_ = 0;     ///< and how many of it are tried
  double near_[kPacks * lanes::kBlock][lanes::kMaxJoints];
  std::size_t near_count_ = 0;
};

}  // namespace iksel
