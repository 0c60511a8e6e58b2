// SPDX-License-Identifier: BSD-3-Clause
// Seeds that spread over all solutions: through the database some blocks at a time, the best seed
// of each first, then at random; and before them the partners predicted from solutions that were
// found.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/work.hpp"
#include "seeds/lane_query.hpp"
#include "seeds/random_seeds.hpp"

namespace iksel {

/// `Known` has what was found: pop_partner(q), wants_more() and is_complete().
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
    blocks_ = static_cast<int>(query_.next_blocks(std::min(most, query_.near_blocks() - given)));
    left_ = blocks_ * lanes::kBlock;
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
    if (known_.is_complete() || left_ == 0 || !work_.take()) return false;
    const int at = blocks_ * lanes::kBlock - left_--;
    if (at_random_) {
      load_random(joints_, random_, refiner, lane);
    } else {
      query_.load(at / blocks_, refiner, lane, at % blocks_);
    }
    return true;
  }

 private:
  LaneQuery& query_;
  const JointSpace& joints_;
  const Known& known_;
  Work& work_;
  Random random_;
  int blocks_ = 0;
  int left_ = 0;
  bool at_random_ = false;
};

}  // namespace iksel
