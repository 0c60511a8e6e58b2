// SPDX-License-Identifier: BSD-3-Clause
// The pipeline with seeds iterated in SIMD lanes: the leaf's block first, then the exact neighbours
// in widening stages, then random restarts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/random.hpp"
#include "base/stage_clock.hpp"
#include "database/data.hpp"
#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"
#include "seeds/farthest_first.hpp"
#include "simd/kernels.hpp"

namespace iksel {

/// True if the options and the chain can be solved in lanes.
bool solves_in_lanes(const ChainModel& model, const DatabaseData& data,
                     const SolverOptions& options);

/// What is to be done after a lane has arrived.
enum class Verdict {
  stop,    ///< nothing more is wanted
  next,    ///< this seed is finished; go on with others
  refine,  ///< it is not quite there; iterate it further
};

/// Seeds and pack iterations so far.
struct Work {
  int attempts = 0;
  int iterations = 0;
  /// Of the attempts, those from seeds that came with the request: on top of max_attempts.
  int given = 0;
};

class LaneSearch {
 public:
  /// `nominal` is the chain that the data belongs to; `model` may differ from it a little.
  LaneSearch(const ChainModel& model, const ChainModel& nominal, const DatabaseData& data,
             const SolverOptions& options, const lanes::LaneKernels& kernels);

  /// Calls `accept(JointVector& q) -> Verdict` for every q that arrives until it says stop (then
  /// true), or the work bound is reached. `seed` may be null.
  template <typename Accept>
  bool search(const Pose& T_base_tcp, const JointVector* seed, StageClock& clock, Work& work,
              const Accept& accept);

  /// As search, but through blocks of the database instead of the nearest samples one by one, with
  /// the seeds far from what was found first, and past lanes on their way to it
  /// (lane_explore.hpp). `steering` tells of what was found, may give seeds of its own, and ends
  /// the search: see Steering in explore.cpp.
  template <typename Accept, typename Steering>
  void explore(const Pose& T_base_tcp, Work& work, const Accept& accept, const Steering& steering);

  /// Iterates `count` seeds for the target that was set, most lanes at a time;
  /// `load(k, lane)` puts seed k into a lane.
  template <typename Load, typename Accept>
  bool iterate(int count, Work& work, const Load& load, const Accept& accept);

  /// One target per lane, each with its kStreamSeeds best seeds one after the other; a lane takes
  /// the next target as soon as it is through with one. `next() -> int` gives the index of a
  /// target, or -1 at the end, and `target(index)` its T_base_tcp. `settle(index, q, work) -> bool`
  /// is told the q of a target that arrived, and says whether it is good; or null if no seed was.
  template <typename Next, typename Target, typename Settle>
  void stream(const Next& next, const Target& target, const Settle& settle);

  void set_target(const Pose& T_base_tcp);
  void load_seed(int lane, const double* q);

 private:
  [[nodiscard]] int attempts_left(const Work& work) const {
    return options_.max_attempts - (work.attempts - work.given);
  }
  /// Y of a target, whose seeds and leaf are asked for next.
  Pose set_query(const Pose& T_base_tcp);
  /// Of the block's seeds, by rank.
  void load_ranked(int rank, int lane);
  void load_slot(const lanes::SeedPack& seeds, int entry, int lane);
  template <typename Load, typename Accept, typename Steering>
  void iterate_steered(int count, Work& work, const Load& load, const Accept& accept,
                       const Steering& steering);
  void set_lane_target(int lane, const Pose& Y);

  const ChainModel& model_;
  const DatabaseData& data_;
  const SolverOptions& options_;
  const lanes::LaneKernels& kernels_;
  Pose base_inverse_, tcp_inverse_;  ///< Y = base_inverse T_base_tcp tcp_inverse
  lanes::Advance advance_;
  lanes::LaneChain chain_;
  lanes::LaneOptions lane_options_;
  lanes::SeedChain seed_chain_;
  lanes::SeedTarget seed_target_{};
  lanes::SeedPack seeds_;
  lanes::LanePack pack_;
  double key_[12] = {};
  std::vector<Neighbour> neighbours_;
  std::vector<float> block_;
  std::vector<float> block_distance2_;
  std::vector<std::uint64_t> block_order_;  ///< squared distance, and the block
  std::vector<lanes::SeedPack> block_seeds_;
  FarthestFirstQueue queue_;
};

/// A seed that is still far off after so many iterations is given up: few such come home.
inline constexpr int kPatience = 8;
/// Seeds that a target of a batch is given before it is solved by itself.
inline constexpr int kStreamSeeds = 2;
/// Squared error that counts as far off [mixed units].
inline constexpr double kFarOff2 = 1e-4;

template <typename Load, typename Accept>
bool LaneSearch::iterate(int count, Work& work, const Load& load, const Accept& accept) {
  const int lanes = kernels_.lanes;
  count = std::min(count, attempts_left(work));
  if (count <= 0) return false;
  int age[lanes::kWidth] = {};
  unsigned alive = 0;
  int next = 0;
  for (int lane = 0; lane < lanes; ++lane) {
    // A lane too many does what another does, and is not watched.
    load(std::min(next, count - 1), lane);
    if (next == count) continue;
    alive |= 1U << static_cast<unsigned>(lane);
    ++next;
  }
  work.attempts += next;
  const int patience = std::min(kPatience, options_.max_iterations);
  while (alive != 0) {
    int budget = options_.max_iterations;
    for (int lane = 0; lane < lanes; ++lane) {
      if ((alive >> static_cast<unsigned>(lane) & 1U) == 0) continue;
      budget =
          std::min(budget, (age[lane] < patience ? patience : options_.max_iterations) - age[lane]);
    }
    const lanes::PackResult result = advance_(chain_, lane_options_, alive, budget, pack_);
    work.iterations += result.iterations;
    for (int lane = 0; lane < lanes; ++lane) {
      const unsigned bit = 1U << static_cast<unsigned>(lane);
      if ((alive & bit) == 0) continue;
      age[lane] += result.iterations;
      bool finished = age[lane] >= options_.max_iterations ||
                      (age[lane] >= patience && !(pack_.error2[lane] < kFarOff2));
      if ((result.done & bit) != 0) {
        JointVector q(model_.dof);
        for (int j = 0; j < model_.dof; ++j) q[j] = pack_.q[j][lane];
        const Verdict verdict = accept(q);
        if (verdict == Verdict::stop) return true;
        finished = finished || verdict == Verdict::next;
      }
      if (!finished) continue;
      if (next < count) {
        load(next++, lane);
        ++work.attempts;
        age[lane] = 0;
      } else {
        alive &= ~bit;
      }
    }
  }
  return false;
}

template <typename Next, typename Target, typename Settle>
void LaneSearch::stream(const Next& next, const Target& target, const Settle& settle) {
  const int lanes = kernels_.lanes;
  const int patience = std::min(kPatience, options_.max_iterations);
  const int most_seeds = std::min(kStreamSeeds, options_.max_attempts);
  struct {
    int index;  ///< of the target; -1: none
    int age;    ///< iterations of the seed
    Work work;
  } at[lanes::kWidth] = {};
  unsigned alive = 0;
  const auto load = [&](int lane) {
    set_lane_target(lane, set_query(target(at[lane].index)));
    kernels_.prepare(seed_chain_, seed_target_, data_.leaves.block(key_), seeds_);
    load_ranked(at[lane].work.attempts++, lane);
    at[lane].age = 0;
  };
  const auto refill = [&](int lane) {
    at[lane] = {next(), 0, {}};
    if (at[lane].index < 0) {
      alive &= ~(1U << static_cast<unsigned>(lane));
    } else {
      alive |= 1U << static_cast<unsigned>(lane);
      load(lane);
    }
  };
  for (int lane = 0; lane < lanes; ++lane) refill(lane);
  // NOLINTNEXTLINE(bugprone-infinite-loop): refill() ends it.
  while (alive != 0) {
    int budget = patience;
    for (int lane = 0; lane < lanes; ++lane) {
      if ((alive >> static_cast<unsigned>(lane) & 1U) != 0) {
        budget = std::min(budget, patience - at[lane].age);
      }
    }
    const lanes::PackResult result = advance_(chain_, lane_options_, alive, budget, pack_);
    for (int lane = 0; lane < lanes; ++lane) {
      if ((alive >> static_cast<unsigned>(lane) & 1U) == 0) continue;
      at[lane].age += result.iterations;
      at[lane].work.iterations += result.iterations;
      if ((result.done >> static_cast<unsigned>(lane) & 1U) != 0) {
        JointVector q(model_.dof);
        for (int j = 0; j < model_.dof; ++j) q[j] = pack_.q[j][lane];
        if (settle(at[lane].index, &q, at[lane].work)) {
          refill(lane);
          continue;
        }
      }
      if (at[lane].age < patience) continue;
      if (at[lane].work.attempts < most_seeds) {
        load(lane);
      } else {
        settle(at[lane].index, nullptr, at[lane].work);
        refill(lane);
      }
    }
  }
}

template <typename Accept>
bool LaneSearch::search(const Pose& T_base_tcp, const JointVector* seed, StageClock& clock,
                        Work& work, const Accept& accept) {
  const auto iterate_ranked = [&](int count) {
    clock.lap(&StageTimes::rank);
    const bool solved = iterate(
        count, work, [this](int k, int lane) { load_ranked(k, lane); }, accept);
    clock.lap(&StageTimes::iterate);
    return solved;
  };
  set_target(T_base_tcp);
  if (seed != nullptr) {
    const auto load = [&](int, int lane) { load_seed(lane, seed->data()); };
    work.given = 1;
    if (iterate(1, work, load, accept)) return true;
    clock.lap(&StageTimes::iterate);
  }
  const float* leaf = data_.leaves.block(key_);
  clock.lap(&StageTimes::query);
  kernels_.prepare(seed_chain_, seed_target_, leaf, seeds_);
  if (iterate_ranked(lanes::kBlock)) return true;

  // Widening stages: each asks for four times as many and tries those it has not tried yet.
  // Their number ends them, and not how many the tree finds: keys may be far out of its range.
  std::size_t done = 0;
  std::size_t asked = 0;
  const std::size_t most = std::min(static_cast<std::size_t>(options_.neighbours), data_.size);
  while (asked < most) {
    const std::size_t k = std::min(std::max<std::size_t>(64, 4 * asked), most);
    asked = k;
    if (attempts_left(work) <= 0) return false;
    const std::size_t found = data_.tree.nearest(key_, k, neighbours_.data());
    std::sort(neighbours_.begin(), neighbours_.begin() + static_cast<std::ptrdiff_t>(found));
    clock.lap(&StageTimes::query);
    for (; done < found; done += lanes::kBlock) {
      const std::size_t count = std::min<std::size_t>(lanes::kBlock, found - done);
      for (int entry = 0; entry < lanes::kBlock; ++entry) {
        const std::size_t i = done + std::min(static_cast<std::size_t>(entry), count - 1);
        write_to_block(data_, neighbours_[i].index, entry, block_.data());
      }
      kernels_.prepare(seed_chain_, seed_target_, block_.data(), seeds_);
      if (iterate_ranked(lanes::kBlock)) return true;
      if (attempts_left(work) <= 0) return false;
    }
    done = found;
  }

  Random random(options_.seed);
  const auto load_random = [&](int, int lane) {
    double q[kMaxDof];
    model_.joints.sample(random, q);
    for (int j = 0; j < model_.dof; ++j) pack_.q[j][lane] = q[j];
  };
  const bool solved = iterate(attempts_left(work), work, load_random, accept);
  clock.lap(&StageTimes::iterate);
  return solved;
}

}  // namespace iksel
