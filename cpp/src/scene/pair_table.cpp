// SPDX-License-Identifier: BSD-3-Clause
#include "scene/pair_table.hpp"

#include <algorithm>
#include <utility>

namespace iksel {

void PairTable::add(const lanes::ScenePair& pair) {
  const auto block_of = [&](int one, int other) {
    return std::find_if(blocks_.begin(), blocks_.end(), [&](const lanes::ScenePairBlock& block) {
      return block.one == one && block.first == other / lanes::kWidth * lanes::kWidth;
    });
  };
  // Either link can be the one that others are held against: few blocks are few to look at.
  int one = pair.a;
  int other = pair.b;
  auto block = block_of(one, other);
  if (block == blocks_.end() && block_of(other, one) != blocks_.end()) {
    std::swap(one, other);
    block = block_of(one, other);
  }
  if (block == blocks_.end()) {
    blocks_.push_back({one, other / lanes::kWidth * lanes::kWidth, 0, {}});
    block = blocks_.end() - 1;
  }
  const int lane = other - block->first;
  block->mask |= 1U << static_cast<unsigned>(lane);
  block->pair[lane] = static_cast<int>(pairs_.size());
  pairs_.push_back(pair);
}

void PairTable::show(lanes::SceneView& view) const {
  view.pairs = static_cast<int>(pairs_.size());
  view.pair = pairs_.data();
  view.pair_blocks = static_cast<int>(blocks_.size());
  view.pair_block = blocks_.data();
}

}  // namespace iksel
