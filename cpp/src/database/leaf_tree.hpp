// SPDX-License-Identifier: BSD-3-Clause
// A KD-tree that is only descended, never searched back: each leaf owns the samples nearest to the
// middle of its keys, laid out for the lanes, so that a query is one walk and a few contiguous
// loads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace iksel {

struct DatabaseData;

class LeafTree {
 public:
  LeafTree() = default;
  /// `data` has its keys, records and exact tree already.
  explicit LeafTree(const DatabaseData& data);

  /// Samples of the leaf that a key falls into, as a group of lanes (lane_types.hpp).
  [[nodiscard]] const float* group(const double* key) const {
    std::size_t node = 0;
    for (int level = 0; level < depth_; ++level) {
      const bool above = key[dimension_[node]] >= value_[node];
      node = 2 * node + 1 + (above ? 1 : 0);
    }
    return &groups_[(node - dimension_.size()) * group_size_];
  }

  [[nodiscard]] std::size_t leaves() const { return dimension_.size() + 1; }

 private:
  int depth_ = 0;
  std::size_t group_size_ = 0;
  // Inner nodes in heap order: the children of i are 2 i + 1 and 2 i + 2.
  std::vector<std::uint8_t> dimension_;
  std::vector<double> value_;
  std::vector<float> groups_;
};

/// Writes sample `index` into place `slot` of a group.
void write_to_group(const DatabaseData& data, std::size_t index, int slot, float* group);

}  // namespace iksel
