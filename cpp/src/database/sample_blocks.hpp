// SPDX-License-Identifier: BSD-3-Clause
// All samples in blocks of near ones, laid out for the lanes: what a search goes through that wants
// more than the nearest few.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace iksel {

struct DatabaseData;

class SampleBlocks {
 public:
  SampleBlocks() = default;
  /// `data` has its keys, in the order of its tree, and records already.
  explicit SampleBlocks(const DatabaseData& data);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// A block's samples as a block of lanes (lane_types.hpp).
  [[nodiscard]] const float* block(std::size_t block) const {
    return &blocks_[block * block_size_];
  }
  /// Squared distance of each block's middle from a key.
  void measure(const double* key, float* distance2) const;

 private:
  std::size_t block_size_ = 0;
  std::size_t size_ = 0;
  /// Places left over in the last block repeat its samples.
  std::vector<float> blocks_;
  /// Mean key of each block, dimension by dimension.
  std::vector<float> middles_;
};

}  // namespace iksel
