// SPDX-License-Identifier: BSD-3-Clause
// All samples in groups of near ones, laid out for the lanes: what a search goes through that wants
// more than the nearest few.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace iksel {

struct DatabaseData;

class Tiles {
 public:
  Tiles() = default;
  /// `data` has its keys, in the order of its tree, and records already.
  explicit Tiles(const DatabaseData& data);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// A tile's samples as a group of lanes (lane_types.hpp).
  [[nodiscard]] const float* group(std::size_t tile) const { return &groups_[tile * group_size_]; }
  /// Squared distance of each tile's middle from a key.
  void measure(const double* key, float* distance2) const;

 private:
  std::size_t group_size_ = 0;
  std::size_t size_ = 0;
  /// Places left over in the last tile repeat its samples.
  std::vector<float> groups_;
  /// Mean key of each tile, dimension by dimension.
  std::vector<float> middles_;
};

}  // namespace iksel
