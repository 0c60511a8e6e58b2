// SPDX-License-Identifier: BSD-3-Clause
// A database's samples laid out for the lanes, in blocks that a kernel loads at once
// (lane_types.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace iksel {

struct DatabaseData;

/// Writes sample `index` into place `entry` of a block.
void write_to_block(const DatabaseData& data, std::size_t index, int entry, float* block);

/// All samples, neighbours in a block.
class SampleBlocks {
 public:
  SampleBlocks() = default;
  /// `data` has its keys, in the order of its tree, and records already.
  explicit SampleBlocks(const DatabaseData& data);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const float* block(std::size_t block) const {
    return &blocks_[block * block_size_];
  }
  /// Bytes of all blocks and their middles.
  [[nodiscard]] std::size_t bytes() const {
    return (blocks_.capacity() + middles_.capacity()) * sizeof(float);
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

/// A KD-tree that is only descended, never searched back: each leaf owns the samples nearest to the
/// middle of its keys, so that a query is one walk and a few contiguous loads.
class LeafIndex {
 public:
  LeafIndex() = default;
  /// `data` has its keys, records and exact tree already.
  explicit LeafIndex(const DatabaseData& data);

  /// Samples of the leaf that a key falls into.
  [[nodiscard]] const float* block(const double* key) const {
    return &blocks_[descend(key, depth_) * block_size_];
  }

  /// Bytes of the tree and its leaves.
  [[nodiscard]] std::size_t bytes() const {
    return blocks_.capacity() * sizeof(float) + value_.capacity() * sizeof(double) +
           dimension_.capacity();
  }
  [[nodiscard]] std::size_t leaves() const { return dimension_.size() + 1; }
  [[nodiscard]] int depth() const { return depth_; }
  /// Number of the node at a level that a key falls into; those of the last are the leaves.
  [[nodiscard]] std::size_t descend(const double* key, int levels) const {
    std::size_t node = 0;
    for (int level = 0; level < levels; ++level) {
      const bool above = key[dimension_[node]] >= value_[node];
      node = 2 * node + 1 + (above ? 1 : 0);
    }
    return node + 1 - (std::size_t{1} << static_cast<unsigned>(levels));
  }

 private:
  /// Splits every node's samples at the median of the coordinate that spreads widest. Returns where
  /// in `order` the samples of each leaf begin, and the end.
  std::vector<std::size_t> split(const DatabaseData& data, std::vector<std::uint32_t>& order);

  int depth_ = 0;
  std::size_t block_size_ = 0;
  // Inner nodes in heap order: the children of i are 2 i + 1 and 2 i + 2.
  std::vector<std::uint8_t> dimension_;
  std::vector<double> value_;
  std::vector<float> blocks_;
};

}  // namespace iksel
