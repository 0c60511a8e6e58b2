// SPDX-License-Identifier: BSD-3-Clause
// Exact k nearest neighbours over the keys of a database, by nanoflann.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace iksel {

/// A neighbour and its squared key distance.
struct Neighbour {
  double distance;
  std::uint32_t index;

  friend bool operator<(const Neighbour& a, const Neighbour& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
  }
};

/// Tree over `count` points of `dimension` doubles, which it refers to and does not own.
class KdTree {
 public:
  KdTree() = default;
  KdTree(const double* points, std::size_t count, int dimension);

  /// Order of the points in which neighbours lie close together in memory.
  [[nodiscard]] std::vector<std::uint32_t> order() const;

  /// The k nearest points, in no order, written to `out` (room for k); returns how many. Allocates
  /// nothing for up to 12 dimensions.
  std::size_t nearest(const double* point, std::size_t k, Neighbour* out) const;

  /// The tree for one dimension; public for its implementations only.
  struct Index {
    virtual ~Index() = default;
    virtual std::size_t nearest(const double* point, std::size_t k, Neighbour* out) const = 0;
    [[nodiscard]] virtual std::vector<std::uint32_t> order() const = 0;
  };

 private:
  std::shared_ptr<const Index> index_;
};

}  // namespace iksel
