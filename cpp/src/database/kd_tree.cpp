// SPDX-License-Identifier: BSD-3-Clause
#include "database/kd_tree.hpp"

#include <algorithm>
#include <limits>
#include <nanoflann.hpp>
#include <type_traits>

namespace iksel {
namespace {

/// nanoflann's view of the points.
struct Points {
  const double* data;
  std::size_t count;
  int dimension;

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return count; }
  [[nodiscard]] double kdtree_get_pt(std::size_t index, std::size_t i) const {
    return data[index * static_cast<std::size_t>(dimension) + i];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

/// Keeps the k nearest in a max-heap: nanoflann's own result set keeps them sorted, which costs
/// more than the search itself for k = 200.
class HeapResult {
 public:
  using DistanceType = double;

  HeapResult(Neighbour* heap, std::size_t capacity) : heap_(heap), capacity_(capacity) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool full() const { return size_ == capacity_; }
  [[nodiscard]] double worstDist() const {
    return full() ? heap_[0].distance : std::numeric_limits<double>::max();
  }
  bool addPoint(double distance, std::uint32_t index) {
    const Neighbour added{distance, index};
    if (!full()) {
      heap_[size_++] = added;
      if (full()) std::make_heap(heap_, heap_ + size_);
    } else if (added < heap_[0]) {
      replace_worst(added);
    }
    return true;
  }

 private:
  void replace_worst(const Neighbour& added) {
    std::size_t hole = 0;
    for (std::size_t child = 1; child < size_; child = 2 * hole + 1) {
      if (child + 1 < size_ && heap_[child] < heap_[child + 1]) ++child;
      if (!(added < heap_[child])) break;
      heap_[hole] = heap_[child];
      hole = child;
    }
    heap_[hole] = added;
  }

  Neighbour* heap_;
  std::size_t capacity_;
  std::size_t size_ = 0;
};

/// Of a dimension known at compile time; -1: of any, and then nanoflann allocates in every query.
template <int kDimension>
class NanoflannTree final : public KdTree {
 public:
  NanoflannTree(const double* data, std::size_t count, int dimension)
      : points_{data, count, dimension},
        tree_(dimension, points_, nanoflann::KDTreeSingleIndexAdaptorParams(/*leaf_max_size=*/16)) {
  }

  std::size_t nearest(const double* point, std::size_t k, Neighbour* out) const override {
    HeapResult result(out, std::min(k, points_.count));
    tree_.findNeighbors(result, point, nanoflann::SearchParams(32, 0.0F, false));
    return result.size();
  }

  [[nodiscard]] std::vector<std::uint32_t> order() const override { return tree_.vAcc; }

  [[nodiscard]] std::size_t bytes() const override {
    return sizeof *this + tree_.pool.usedMemory + tree_.pool.wastedMemory +
           tree_.vAcc.capacity() * sizeof(std::uint32_t);
  }

 private:
  using Metric = nanoflann::L2_Simple_Adaptor<double, Points, double, std::uint32_t>;
  Points points_;
  nanoflann::KDTreeSingleIndexAdaptor<Metric, Points, kDimension, std::uint32_t> tree_;
};

template <int... kDimensions>
std::shared_ptr<const KdTree> make_tree(const double* points, std::size_t count, int dimension) {
  std::shared_ptr<const KdTree> tree;
  const auto make = [&](auto known) {
    tree = std::make_shared<NanoflannTree<known()>>(points, count, dimension);
  };
  ((dimension == kDimensions ? make(std::integral_constant<int, kDimensions>()) : void()), ...);
  if (!tree) make(std::integral_constant<int, -1>());
  return tree;
}

}  // namespace

std::shared_ptr<const KdTree> make_kd_tree(const double* points, std::size_t count, int dimension) {
  // Those of keys.
  return make_tree<5, 6, 7, 8, 9, 12>(points, count, dimension);
}

}  // namespace iksel
