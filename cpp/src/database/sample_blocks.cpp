// SPDX-License-Identifier: BSD-3-Clause
#include "database/sample_blocks.hpp"

#include <algorithm>
#include <numeric>

#include "database/data.hpp"
#include "database/key.hpp"
#include "iksel/error.hpp"
#include "simd/lane_types.hpp"

namespace iksel {
namespace {

/// The coordinate in which the keys of some samples spread widest.
template <typename Iterator>
std::size_t widest_coordinate(const DatabaseData& data, Iterator begin, Iterator end) {
  const auto dim = static_cast<std::size_t>(data.key_dim);
  std::size_t widest = 0;
  double most = -1;
  for (std::size_t d = 0; d < dim; ++d) {
    const auto [low, high] = std::minmax_element(begin, end, [&](auto a, auto b) {
      return data.keys[a * dim + d] < data.keys[b * dim + d];
    });
    const double spread = data.keys[*high * dim + d] - data.keys[*low * dim + d];
    if (spread > most) {
      most = spread;
      widest = d;
    }
  }
  return widest;
}

/// Writes the samples nearest to the mean key of a leaf's `count` samples.
void fill_leaf(const DatabaseData& data, const std::uint32_t* samples, std::size_t count,
               float* block) {
  const auto dim = static_cast<std::size_t>(data.key_dim);
  double mean[kMaxKeyDimension] = {};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t d = 0; d < dim; ++d) mean[d] += data.keys[samples[i] * dim + d];
  }
  for (double& m : mean) m /= static_cast<double>(count);
  std::vector<Neighbour> nearest(lanes::kBlock);
  const std::size_t found = data.tree->nearest(mean, nearest.size(), nearest.data());
  if (found == 0) throw DatabaseError("a leaf of the database has no sample near it");
  nearest.resize(found);
  std::sort(nearest.begin(), nearest.end());
  for (int entry = 0; entry < lanes::kBlock; ++entry) {
    // A database smaller than a block repeats itself.
    const std::size_t index = nearest[static_cast<std::size_t>(entry) % found].index;
    write_to_block(data, index, entry, block);
  }
}

}  // namespace

void write_to_block(const DatabaseData& data, std::size_t index, int entry, float* block) {
  const double* x = data.x(index);
  const Eigen::Matrix3d R = from_rotation_vector(Eigen::Map<const Eigen::Vector3d>(x + 3));
  float* at = block + entry;
  const auto put = [&](double value) {
    *at = static_cast<float>(value);
    at += lanes::kBlock;
  };
  for (int i = 0; i < 3; ++i) put(x[i]);
  for (int column = 0; column < 3; ++column) {
    for (int i = 0; i < 3; ++i) put(R(i, column));
  }
  for (int j = 0; j < data.dof; ++j) put(data.q(index)[j]);
  const double* pinv = data.pseudo_inverse(index);
  for (int j = 0; j < data.dof; ++j) {
    for (int r = 0; r < 6; ++r) put(pinv[r * data.dof + j]);
  }
}

SampleBlocks::SampleBlocks(const DatabaseData& data)
    : block_size_(static_cast<std::size_t>(lanes::block_rows(data.dof) * lanes::kBlock)),
      size_((data.size + lanes::kBlock - 1) / lanes::kBlock) {
  const auto dim = static_cast<std::size_t>(data.key_dim);
  blocks_.resize(size_ * block_size_);
  middles_.resize(dim * size_);
  for (std::size_t block = 0; block < size_; ++block) {
    // Neighbours in the tree's order are near each other.
    const std::size_t first = block * lanes::kBlock;
    const std::size_t count = std::min<std::size_t>(lanes::kBlock, data.size - first);
    for (std::size_t entry = 0; entry < lanes::kBlock; ++entry) {
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

LeafIndex::LeafIndex(const DatabaseData& data)
    : block_size_(static_cast<std::size_t>(lanes::block_rows(data.dof) * lanes::kBlock)) {
  // So deep that four samples are left for a leaf, or a few more.
  while ((data.size >> static_cast<unsigned>(depth_ + 1)) >= 4) ++depth_;
  std::vector<std::uint32_t> order(data.size);
  std::iota(order.begin(), order.end(), 0U);
  const std::vector<std::size_t> bounds = split(data, order);
  blocks_.resize((bounds.size() - 1) * block_size_);
  for (std::size_t leaf = 0; leaf + 1 < bounds.size(); ++leaf) {
    fill_leaf(data, &order[bounds[leaf]], bounds[leaf + 1] - bounds[leaf],
              &blocks_[leaf * block_size_]);
  }
}

std::vector<std::size_t> LeafIndex::split(const DatabaseData& data,
                                          std::vector<std::uint32_t>& order) {
  const auto dim = static_cast<std::size_t>(data.key_dim);
  std::vector<std::size_t> bounds = {0, data.size};
  for (int level = 0; level < depth_; ++level) {
    std::vector<std::size_t> next = {0};
    for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
      const auto begin = order.begin() + static_cast<std::ptrdiff_t>(bounds[k]);
      const auto end = order.begin() + static_cast<std::ptrdiff_t>(bounds[k + 1]);
      const std::size_t widest = widest_coordinate(data, begin, end);
      const auto middle = begin + (end - begin) / 2;
      std::nth_element(begin, middle, end, [&](auto a, auto b) {
        return data.keys[a * dim + widest] < data.keys[b * dim + widest];
      });
      dimension_.push_back(static_cast<std::uint8_t>(widest));
      value_.push_back(data.keys[*middle * dim + widest]);
      next.push_back(static_cast<std::size_t>(middle - order.begin()));
      next.push_back(bounds[k + 1]);
    }
    bounds = std::move(next);
  }
  return bounds;
}

}  // namespace iksel
