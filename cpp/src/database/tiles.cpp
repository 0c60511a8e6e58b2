// SPDX-License-Identifier: BSD-3-Clause
#include "database/tiles.hpp"

#include <algorithm>

#include "database/data.hpp"
#include "lanes/lane_types.hpp"

namespace iksel {

Tiles::Tiles(const DatabaseData& data)
    : group_size_(static_cast<std::size_t>(lanes::group_rows(data.dof) * lanes::kGroup)),
      size_((data.size + lanes::kGroup - 1) / lanes::kGroup) {
  constexpr auto kGroup = static_cast<std::size_t>(lanes::kGroup);
  const auto dim = static_cast<std::size_t>(data.key_dim);
  groups_.resize(size_ * group_size_);
  middles_.resize(dim * size_);
  for (std::size_t tile = 0; tile < size_; ++tile) {
    // Neighbours in the tree's order are near each other.
    const std::size_t first = tile * kGroup;
    const std::size_t count = std::min(kGroup, data.size - first);
    for (std::size_t slot = 0; slot < kGroup; ++slot) {
      write_to_group(data, first + slot % count, static_cast<int>(slot),
                     &groups_[tile * group_size_]);
    }
    for (std::size_t d = 0; d < dim; ++d) {
      double sum = 0;
      for (std::size_t i = first; i < first + count; ++i) sum += data.keys[i * dim + d];
      middles_[d * size_ + tile] = static_cast<float>(sum / static_cast<double>(count));
    }
  }
}

void Tiles::measure(const double* key, float* distance2) const {
  std::fill_n(distance2, size(), 0.0F);
  const float* middle = middles_.data();
  const float* const end = middle + middles_.size();
  for (; middle != end; middle += size(), ++key) {
    const auto k = static_cast<float>(*key);
    for (std::size_t tile = 0; tile < size(); ++tile) {
      const float d = middle[tile] - k;
      distance2[tile] += d * d;
    }
  }
}

}  // namespace iksel
