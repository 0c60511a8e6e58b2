// SPDX-License-Identifier: BSD-3-Clause
// Seeds of a goal that has no answer: many are moved towards where the least is missing, in single
// precision and many abreast, and of those that come nearest some go on.
#pragma once

#include <cstdint>
#include <vector>

#include "goal/goal.hpp"
#include "kinematics/chain_model.hpp"
#include "seeds/lane_query.hpp"
#include "simd/kernels.hpp"
#include "simd/lane_chain.hpp"

namespace iksel {

class ClosestScreen {
 public:
  /// Its random seeds are drawn here, once for all goals.
  ClosestScreen(const ChainModel& model, std::uint64_t seed, const lanes::LaneKernels& kernels);

  /// Where seeds of the goal came to, the nearest first: from samples of the database near the
  /// target, and at random. `weights` [1/m, 1/rad] as of PoseWeights. Of a task with widths, packs
  /// of seeds head for different poses that it allows.
  void find(const Goal& goal, const Vector6& weights, LaneQuery& query);
  /// False where lanes only came near to what the goal measures, and may be led astray: of a twist,
  /// which a trace does not see beside a swing by half a turn, and of tasks with widths.
  [[nodiscard]] bool is_measured() const { return is_measured_; }
  /// How many there are.
  [[nodiscard]] static int size() { return lanes::kBlock; }
  [[nodiscard]] JointVector q(int i) const;
  /// What is missing there, in units of its own.
  [[nodiscard]] float remainder(int i) const {
    return seeds_[static_cast<std::size_t>(i)].remainder;
  }
  /// What the last few iterations took away of it: nothing where the seed has come to rest.
  [[nodiscard]] float gained(int i) const { return seeds_[static_cast<std::size_t>(i)].gained; }
  /// Seeds that find() moves.
  [[nodiscard]] static int moved() { return kPacks * lanes::kBlock; }

 private:
  /// Packs of seeds: of the nearest leaf and block of the database, and at random. More at random
  /// gained nothing: with 6, 12 and 32 packs the same 5 of 834 targets of panda were missed.
  static constexpr int kRandomPacks = 6;
  static constexpr int kPacks = 2 + kRandomPacks;

  struct Seed {
    float remainder;
    float gained;  ///< by the last move
    int place;     ///< in the packs, one after the other
  };

  void use_length(const Vector6& squares);
  void add_target(const Pose& allowed, const Goal& goal, const Vector6& squares);
  /// Returns the packs that there are.
  int load_seeds(LaneQuery& query);
  /// Moves all seeds of the first packs, which are those of seeds_.
  void move(int packs, int iterations);
  /// Packs the best seeds anew, best first.
  void keep(int packs);
  /// Values of joint j in a pack.
  float* row(std::vector<float>& packs, int pack, int j) const {
    return packs.data() + (pack * chain_.n + j) * lanes::kBlock;
  }

  const ChainModel& model_;
  const lanes::LaneKernels& kernels_;
  Pose base_inverse_, last_to_tcp_;
  double length_ = 1;                ///< [m]
  lanes::LaneChainOf<float> chain_;  ///< in that unit
  std::uint64_t seed_;
  std::vector<float> random_;                                 ///< packs of joint values [rad or m]
  std::vector<float> packs_, kept_;                           ///< [rad or length_]
  std::vector<lanes::ClosestTarget> targets_, kept_targets_;  ///< of each pack
  std::vector<Seed> seeds_;
  bool is_measured_ = true;
};

}  // namespace iksel
