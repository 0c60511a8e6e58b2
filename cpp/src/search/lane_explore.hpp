// SPDX-License-Identifier: BSD-3-Clause
// A search in lanes that goes on after a solution: through the database block by block, always with
// the seed farthest from what was found, then random restarts; and past every seed that is on its
// way to what is known.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "search/lane_search.hpp"

namespace iksel {

/// Iterations after which it is looked where a seed is heading.
inline constexpr int kLook = 2;
/// As kPatience, where a seed more or less does not matter: solutions arrive after 4 iterations in
/// the mean, and what is far off after 6 costs more than what it finds.
inline constexpr int kExplorePatience = 6;

/// The joint values of one lane.
struct LaneColumn {
  const double (&rows)[lanes::kMaxJoints][lanes::kWidth];
  int lane;
  double operator[](int joint) const { return rows[joint][lane]; }
};

template <typename Load, typename Accept, typename Steering>
void LaneSearch::iterate_steered(int count, Work& work, const Load& load, const Accept& accept,
                                 const Steering& steering) {
  const int lanes = kernels_.lanes;
  const int patience = std::min(kExplorePatience, options_.max_iterations);
  int age[lanes::kWidth] = {};
  int next_look[lanes::kWidth] = {};
  unsigned alive = 0;
  unsigned sure = 0;  ///< may come near to what is known
  int next = 0;
  const auto refill = [&](int lane) {
    const unsigned bit = 1U << static_cast<unsigned>(lane);
    alive &= ~bit;
    sure &= ~bit;
    JointVector given;
    if (steering.take(given)) {
      load_seed(lane, given.data());
      age[lane] = 0;
      alive |= bit;
      sure |= bit;
      return;
    }
    while (!steering.exhausted() && next < count && attempts_left(work) > 0) {
      ++work.attempts;
      ++next;
      if (!load(lane)) continue;
      age[lane] = 0;
      next_look[lane] = kLook;
      alive |= bit;
      return;
    }
  };
  for (int lane = 0; lane < lanes; ++lane) refill(lane);
  // NOLINTNEXTLINE(bugprone-infinite-loop): refill() ends it.
  while (alive != 0) {
    int budget = std::min(kLook, options_.max_iterations);
    for (int lane = 0; lane < lanes; ++lane) {
      if ((alive >> static_cast<unsigned>(lane) & 1U) == 0) continue;
      budget = std::min(budget, options_.max_iterations - age[lane]);
    }
    const lanes::PackResult result = advance_(chain_, lane_options_, alive, budget, pack_);
    work.iterations += result.iterations;
    for (int lane = 0; lane < lanes; ++lane) {
      const unsigned bit = 1U << static_cast<unsigned>(lane);
      if ((alive & bit) == 0) continue;
      age[lane] += result.iterations;
      bool finished = age[lane] >= options_.max_iterations ||
                      (age[lane] >= patience && !(pack_.error2[lane] < kFarOff2));
      const bool look = age[lane] >= next_look[lane] && (sure & bit) == 0;
      if (look) next_look[lane] = age[lane] + kLook;
      if (look && !finished && steering.knows(LaneColumn{pack_.q, lane})) {
        finished = true;
      } else if ((result.done & bit) != 0) {
        JointVector q(model_.dof);
        for (int j = 0; j < model_.dof; ++j) q[j] = pack_.q[j][lane];
        const Verdict verdict = accept(q);
        if (verdict == Verdict::stop) return;
        finished = finished || verdict == Verdict::next;
      }
      if (finished) refill(lane);
    }
  }
}

template <typename Accept, typename Steering>
void LaneSearch::explore(const Pose& T_base_tcp, Work& work, const Accept& accept,
                         const Steering& steering) {
  set_target(T_base_tcp);
  const SampleBlocks& blocks = data_.blocks;
  blocks.measure(key_, block_distance2_.data());
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    // Squares are not negative, and so in the order of their bits; of equals the first.
    std::uint32_t bits = 0;
    std::memcpy(&bits, &block_distance2_[block], sizeof bits);
    block_order_[block] = std::uint64_t{bits} << 32U | block;
  }
  const auto go_on = [&] { return steering.go_on() && attempts_left(work) > 0; };
  const std::size_t wanted =
      (static_cast<std::size_t>(options_.neighbours) + lanes::kBlock - 1) / lanes::kBlock;
  const std::size_t most = std::min(wanted, blocks.size());
  for (std::size_t done = 0; done < most;) {
    // One alone at first where any answer will do: it may have one.
    const bool one = done == 0 && !steering.wants_more();
    const std::size_t count = std::min(one ? 1 : block_seeds_.size(), most - done);
    const auto begin = block_order_.begin() + static_cast<std::ptrdiff_t>(done);
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    std::partial_sort(begin, end, block_order_.end());
    for (std::size_t t = 0; t < count; ++t) {
      const auto block = static_cast<std::uint32_t>(block_order_[done + t]);
      kernels_.prepare(seed_chain_, seed_target_, blocks.block(block), block_seeds_[t]);
    }
    queue_.reset(block_seeds_.data(), static_cast<int>(count));
    std::size_t added = 0;
    const auto load = [&](int lane) {
      for (; added < steering.known(); ++added) {
        queue_.add_known(steering.solution(added));
      }
      float distance = 0;
      const int k = queue_.take(distance);
      if (distance < steering.basin_radius) return false;
      for (int j = 0; j < model_.dof; ++j) pack_.q[j][lane] = queue_.q(j, k);
      return true;
    };
    iterate_steered(static_cast<int>(count) * lanes::kBlock, work, load, accept, steering);
    done += count;
    if (!go_on()) return;
  }

  Random random(options_.seed);
  const auto load_random = [&](int lane) {
    double q[kMaxDof];
    model_.joints.sample(random, q);
    for (int j = 0; j < model_.dof; ++j) pack_.q[j][lane] = q[j];
    return true;
  };
  do {
    iterate_steered(kBlocksAtOnce * lanes::kBlock, work, load_random, accept, steering);
  } while (go_on());
}

}  // namespace iksel
