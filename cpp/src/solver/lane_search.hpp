// SPDX-License-Identifier: BSD-3-Clause
// The pipeline with seeds iterated in SIMD lanes: the leaf's group first, then the exact neighbours
// in widening stages, then random restarts.
#pragma once

#include <algorithm>
#include <vector>

#include "database/data.hpp"
#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"
#include "lanes/kernels.hpp"
#include "math/random.hpp"
#include "solver/stage_clock.hpp"

namespace iksel {

/// True if the options and the chain can be solved in lanes.
bool solves_in_lanes(const ChainModel& model, const DatabaseData& data,
                     const SolverOptions& options);

class LaneSearch {
 public:
  LaneSearch(const ChainModel& model, const DatabaseData& data, const SolverOptions& options,
             const lanes::LaneKernels& kernels);

  /// Calls `accept(q)` for every converged q until it says true, or the work bound is reached.
  /// `seed` may be null. Counts seeds and pack iterations. `go_on()` is asked after each group of
  /// seeds; false ends the search.
  template <typename Accept, typename GoOn>
  bool run(const Pose& tip_target, const JointVector* seed, StageClock& clock, int& attempts,
           int& iterations, const Accept& accept, const GoOn& go_on);
  template <typename Accept>
  bool run(const Pose& tip_target, const JointVector* seed, StageClock& clock, int& attempts,
           int& iterations, const Accept& accept) {
    return run(tip_target, seed, clock, attempts, iterations, accept, [] { return true; });
  }

  void set_target(const Pose& tip_target);
  template <typename Accept>
  bool iterate_seed(const double* q, int& attempts, int& iterations, const Accept& accept) {
    load_seed(q);
    return solve_seeds(1, attempts, iterations, accept);
  }

 private:
  void load_seed(const double* q) {
    for (int j = 0; j < model_.dof; ++j) {
      seeds_[static_cast<std::size_t>(j * lanes::kGroup)] =
          std::min(std::max(q[j], chain_.joint[j].limited ? model_.lower[j] : q[j]),
                   chain_.joint[j].limited ? model_.upper[j] : q[j]);
    }
  }
  /// The seeds of a group that lie inside the limits, moved to the front; how many.
  int prepare(const double* group);
  template <typename Accept>
  bool solve_seeds(int count, int& attempts, int& iterations, const Accept& accept);

  const ChainModel& model_;
  const DatabaseData& data_;
  const SolverOptions& options_;
  const lanes::LaneKernels& kernels_;
  lanes::SolvePack solve_pack_;
  lanes::LaneChain chain_;
  lanes::LaneOptions lane_options_;
  lanes::LaneReduction reduction_;
  lanes::LaneTarget target_;
  double key_[12] = {};
  std::vector<Neighbour> neighbours_;
  std::vector<double> group_;
  std::vector<double> seeds_;
};

template <typename Accept>
bool LaneSearch::solve_seeds(int count, int& attempts, int& iterations, const Accept& accept) {
  JointVector q(model_.dof);
  count = std::min(count, options_.max_attempts - attempts);
  for (int first = 0; first < count; first += kernels_.lanes) {
    // A pack that is not full repeats its first seed.
    for (int s = count; s < first + kernels_.lanes; ++s) {
      for (int j = 0; j < model_.dof; ++j) {
        seeds_[static_cast<std::size_t>(j * lanes::kGroup + s)] =
            seeds_[static_cast<std::size_t>(j * lanes::kGroup + first)];
      }
    }
    attempts += std::min(kernels_.lanes, count - first);
    const lanes::PackResult result =
        solve_pack_(chain_, target_, lane_options_, seeds_.data() + first, q.data());
    iterations += result.iterations;
    if (result.lane >= 0 && accept(q)) return true;
  }
  return false;
}

template <typename Accept, typename GoOn>
bool LaneSearch::run(const Pose& tip_target, const JointVector* seed, StageClock& clock,
                     int& attempts, int& iterations, const Accept& accept, const GoOn& go_on) {
  const auto iterate = [&](int count) {
    clock.lap(&StageTimes::rank);
    const bool solved = solve_seeds(count, attempts, iterations, accept);
    clock.lap(&StageTimes::iterate);
    return solved;
  };
  set_target(tip_target);
  if (seed != nullptr) {
    load_seed(seed->data());
    if (iterate(1)) return true;
  }
  const double* leaf = data_.leaves.group(key_);
  clock.lap(&StageTimes::query);
  if (iterate(prepare(leaf))) return true;
  if (!go_on()) return false;

  // Widening stages: each asks for four times as many and tries those it has not tried yet.
  std::size_t done = 0;
  const auto most = static_cast<std::size_t>(options_.neighbours);
  for (std::size_t k = std::min<std::size_t>(32, most); done < std::min(most, data_.size);
       k = std::min(4 * k, most)) {
    const std::size_t found = data_.tree.nearest(key_, std::min(k, data_.size), neighbours_.data());
    std::sort(neighbours_.begin(), neighbours_.begin() + static_cast<std::ptrdiff_t>(found));
    clock.lap(&StageTimes::query);
    for (; done < found; done += lanes::kGroup) {
      for (int slot = 0; slot < lanes::kGroup; ++slot) {
        const std::size_t i = std::min(done + static_cast<std::size_t>(slot), found - 1);
        write_to_group(data_, neighbours_[i].index, slot, group_.data());
      }
      if (attempts >= options_.max_attempts) return false;
      if (iterate(prepare(group_.data()))) return true;
      if (!go_on()) return false;
    }
    done = found;
  }

  Random random(options_.seed);
  while (attempts < options_.max_attempts) {
    for (int s = 0; s < lanes::kGroup; ++s) {
      for (int j = 0; j < model_.dof; ++j) {
        seeds_[static_cast<std::size_t>(j * lanes::kGroup + s)] =
            random.uniform(model_.sample_lower(j), model_.sample_upper(j));
      }
    }
    if (iterate(lanes::kGroup)) return true;
    if (!go_on()) return false;
  }
  return false;
}

}  // namespace iksel
