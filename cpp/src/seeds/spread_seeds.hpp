// SPDX-License-Identifier: BSD-3-Clause
// Seeds that spread over all solutions: through the database block by block, always the seed
// farthest from what was found first, then at random; and before them the partners predicted from
// solutions that were found.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/work.hpp"
#include "seeds/lane_query.hpp"
#include "seeds/random_seeds.hpp"

namespace iksel {

/// `Known` has what was found: pop_partner(q), wants_more(), is_complete(), known(), their
/// number, solution(i), and basin_radius(), within which seeds need not be tried.
template <typename Known>
class SpreadSeeds {
 public:
  SpreadSeeds(LaneQuery& query, const JointSpace& joints, std::uint64_t seed, const Known& known,
              Work& work)
      : query_(query), joints_(joints), known_(known), work_(work), random_(seed) {
    query.begin_blocks();
  }

  bool next_stage() {
    if (!work_.has_left()) return false;
    left_ = kBlocksAtOnce * lanes::kBlock;
    const std::size_t given = query_.blocks_given();
    at_random_ = given == query_.near_blocks();
    if (at_random_) return true;
    // One alone at first where any answer will do: it may have one.
    const std::size_t most = given == 0 && !known_.wants_more() ? 1 : kBlocksAtOnce;
    const auto count =
        static_cast<int>(query_.next_blocks(std::min(most, query_.near_blocks() - given)));
    query_.queue.reset(query_.packs, count);
    added_ = 0;
    left_ = count * lanes::kBlock;
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    JointVector partner;
    if (known_.pop_partner(partner)) {
      work_.take_guess();
      refiner.load_seed(lane, partner.data());
      refiner.follow(lane);
      return true;
    }
    while (!known_.is_complete()) {
      if (left_ == 0 || !work_.take()) return false;
      --left_;
      if (at_random_) {
        load_random(joints_, random_, refiner, lane);
        return true;
      }
      for (; added_ < known_.known(); ++added_) query_.queue.add_known(known_.solution(added_));
      float distance = 0;
      const int k = query_.queue.pop(distance);
      if (distance < known_.basin_radius()) continue;
      refiner.load(lane, [&](int j) { return query_.queue.q(j, k); });
      return true;
    }
    return false;
  }

 private:
  LaneQuery& query_;
  const JointSpace& joints_;
  const Known& known_;
  Work& work_;
  Random random_;
  std::size_t added_ = 0;
  int left_ = 0;
  bool at_random_ = false;
};

}  // namespace iksel
