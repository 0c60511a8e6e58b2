// SPDX-License-Identifier: BSD-3-Clause
#include "database/sample_blocks.hpp"

#include <algorithm>

#include "database/data.hpp"
#include "simd/lane_types.hpp"

namespace iksel {

SampleBlocks::SampleBlocks(const DatabaseData& data)
    : block_size_(static_cast<std::size_t>(lanes::block_rows(data.dof) * lanes::kBlock)),
      size_((data.size + lanes::kBlock - 1) / lanes::kBlock) {
  constexpr auto kBlock = static_cast<std::size_t>(lanes::kBlock);
  const auto dim = static_cast<std::size_t>(data.key_dim);
  blocks_.resize(size_ * block_size_);
  middles_.resize(dim * size_);
  for (std::size_t block = 0; block < size_; ++block) {
    // Neighbours in the tree's order are near each other.
    const std::size_t first = block * kBlock;
    const std::size_t count = std::min(kBlock, data.size - first);
    for (std::size_t entry = 0; entry < kBlock; ++entry) {
      write_to_block(data, first + entry % count, static_cast<int>(entry),
                     &blocks_[block * block_size_]);
    }
    for (std::size_t d = 0; d < dim; ++d) {
      double sum = 0;
      for (std::size_t i = first; i < first + count; ++i) sum += data.keys[i * dim + d];
      middles_[d * size_ + block] = static_cast<float>(sum / static_cast<double>(count));
    }
  }
}

void SampleBlocks::measure(const double* key, float* distance2) const {
  std::fill_n(distance2, size(), 0.0F);
  const float* middle = middles_.data();
  const float* const end = middle + middles_.size();
  for (; middle != end; middle += size(), ++key) {
    const auto k = static_cast<float>(*key);
    for (std::size_t block = 0; block < size(); ++block) {
      const float d = middle[block] - k;
      distance2[block] += d * d;
    }
  }
}

}  // namespace iksel
