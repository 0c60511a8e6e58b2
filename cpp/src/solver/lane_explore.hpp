// SPDX-License-Identifier: BSD-3-Clause
// A search in lanes that goes on after a solution: through the database tile by tile, then random
// restarts, and past every seed that is on its way to what is known.
#pragma once

#include <algorithm>
#include <numeric>

#include "solver/lane_search.hpp"

namespace iksel {

/// Iterations after which it is looked where a seed is heading.
inline constexpr int kLook = 2;
/// As kPatience, where a seed more or less does not matter: solutions arrive after 4 iterations in
/// the mean, and what is far off after 6 costs more than what it finds.
inline constexpr int kExplorePatience = 6;

/// A column of joint values in lanes.
template <typename Rows>
struct LaneColumn {
  const Rows& rows;
  int lane;
  double operator[](int joint) const { return static_cast<double>(rows[joint][lane]); }
};

template <typename Skips, typename Load, typename Accept, typename Steering>
void LaneSearch::iterate_steered(int count, Work& work, const Skips& skips, const Load& load,
                                 const Accept& accept, const Steering& steering) {
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
    while (!steering.exhausted() && next < count && work.attempts < options_.max_attempts) {
      ++work.attempts;
      const int k = next++;
      if (skips(k)) continue;
      load(k, lane);
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
      using Column = LaneColumn<decltype(pack_.q)>;
      const bool look = age[lane] >= next_look[lane] && (sure & bit) == 0;
      if (look) next_look[lane] = age[lane] + kLook;
      if (look && !finished && steering.knows(Column{pack_.q, lane})) {
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
  const Tiles& tiles = data_.tiles;
  tiles.measure(key_, tile_distance2_.data());
  std::iota(tile_order_.begin(), tile_order_.end(), 0U);
  const auto nearer = [this](std::uint32_t a, std::uint32_t b) {
    return tile_distance2_[a] != tile_distance2_[b] ? tile_distance2_[a] < tile_distance2_[b]
                                                    : a < b;
  };
  const auto go_on = [&] { return steering.go_on() && work.attempts < options_.max_attempts; };
  const std::size_t wanted =
      (static_cast<std::size_t>(options_.neighbours) + lanes::kGroup - 1) / lanes::kGroup;
  const std::size_t most = std::min(wanted, tiles.size());
  for (std::size_t done = 0; done < most;) {
    const std::size_t count = std::min(tile_seeds_.size(), most - done);
    const auto begin = tile_order_.begin() + static_cast<std::ptrdiff_t>(done);
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    std::partial_sort(begin, end, tile_order_.end(), nearer);
    for (std::size_t t = 0; t < count; ++t) {
      const std::uint32_t tile = tile_order_[done + t];
      kernels_.prepare(seed_chain_, seed_target_, tiles.group(tile), tile_seeds_[t]);
    }
    // The best of each tile, then the second best, and so on.
    const auto pack_of = [&](int k) -> const lanes::SeedPack& {
      return tile_seeds_[static_cast<std::size_t>(k) % count];
    };
    const auto slot_of = [&](int k) {
      return static_cast<int>(pack_of(k).order[static_cast<std::size_t>(k) / count]);
    };
    const auto skips = [&](int k) {
      using Column = LaneColumn<decltype(lanes::SeedPack::q)>;
      return steering.knows(Column{pack_of(k).q, slot_of(k)});
    };
    const auto load = [&](int k, int lane) { load_slot(pack_of(k), slot_of(k), lane); };
    iterate_steered(static_cast<int>(count) * lanes::kGroup, work, skips, load, accept, steering);
    done += count;
    if (!go_on()) return;
  }

  Random random(options_.seed);
  const auto none = [](int) { return false; };
  const auto load_random = [&](int, int lane) {
    for (int j = 0; j < model_.dof; ++j) {
      pack_.q[j][lane] = random.uniform(model_.sample_lower(j), model_.sample_upper(j));
    }
  };
  do {
    iterate_steered(kTilesAtOnce * lanes::kGroup, work, none, load_random, accept, steering);
  } while (go_on());
}

}  // namespace iksel
