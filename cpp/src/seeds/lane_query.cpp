// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/lane_query.hpp"

#include <algorithm>
#include <cstring>

namespace iksel {

LaneQuery::LaneQuery(const ChainModel& model, const ChainModel& nominal, const DatabaseData& data,
                     int neighbours, const lanes::LaneKernels& kernels)
    : data_(data),
      kernels_(kernels),
      base_inverse_(to_pose(model.kernel.base).inverse()),
      tcp_inverse_(Pose(model.tcp_inverse) * to_pose(model.kernel.flange).inverse()),
      seed_chain_(make_seed_chain(nominal, *data.reduction)),
      near_blocks_(
          std::min((static_cast<std::size_t>(neighbours) + lanes::kBlock - 1) / lanes::kBlock,
                   data.blocks.size())),
      block_distance2_(data.blocks.size()),
      block_order_(data.blocks.size()),
      is_tried_(data.blocks.size()) {}

void LaneQuery::set_target(const Pose& Y) {
  data_.reduction->make_key(Y, key_);
  seed_target_ = make_seed_target(Y);
}

void LaneQuery::begin_blocks() {
  data_.blocks.measure(key_, block_distance2_.data());
  for (std::size_t block = 0; block < block_order_.size(); ++block) {
    // Squares are not negative, and so in the order of their bits; of equals the first.
    std::uint32_t bits = 0;
    std::memcpy(&bits, &block_distance2_[block], sizeof bits);
    block_order_[block] = std::uint64_t{bits} << 32U | block;
  }
  blocks_given_ = 0;
}

std::size_t LaneQuery::next_blocks(std::size_t most) {
  const std::size_t count = std::min(most, block_order_.size() - blocks_given_);
  const auto begin = block_order_.begin() + static_cast<std::ptrdiff_t>(blocks_given_);
  std::partial_sort(begin, begin + static_cast<std::ptrdiff_t>(count), block_order_.end());
  for (std::size_t i = 0; i < count; ++i) {
    const auto block = static_cast<std::uint32_t>(block_order_[blocks_given_ + i]);
    prepare(data_.blocks.block(block), packs[i]);
  }
  blocks_given_ += count;
  return count;
}

bool LaneQuery::find(const Goal& /*goal*/, const Pose& allowed, bool is_first) {
  set_target(reduce(allowed));
  if (is_first) {
    prepare_leaf();
    is_tried_.assign(is_tried_.size(), false);
    return true;
  }
  data_.blocks.measure(key_, block_distance2_.data());
  const std::size_t blocks = block_distance2_.size();
  std::size_t nearest = blocks;
  for (std::size_t i = 0; i < blocks; ++i) {
    if (is_tried_[i]) continue;
    if (nearest == blocks || block_distance2_[i] < block_distance2_[nearest]) nearest = i;
  }
  if (nearest == blocks) return false;
  is_tried_[nearest] = true;
  prepare(data_.blocks.block(nearest), packs[0]);
  return true;
}

}  // namespace iksel
