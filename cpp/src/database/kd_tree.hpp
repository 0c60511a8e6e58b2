// SPDX-License-Identifier: BSD-3-Clause
// Exact k nearest neighbours, by nanoflann.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace iksel {

/// A neighbour and its squared distance.
struct Neighbour {
  double distance;
  std::uint32_t index;

  friend bool operator<(const Neighbour& a, const Neighbour& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
  }
};

class KdTree {
 public:
  virtual ~KdTree() = default;
  /// Order of the points in which neighbours lie close together in memory.
  [[nodiscard]] virtual std::vector<std::uint32_t> order() const = 0;
  /// The k nearest points, in no order, written to `out` (room for k); returns how many. Allocates
  /// nothing in the dimensions that a database's key may have.
  virtual std::size_t nearest(const double* point, std::size_t k, Neighbour* out) const = 0;
  /// Bytes that it takes besides the points.
  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

/// Tree over `count` points of `dimension` doubles, which it refers to and does not own.
std::shared_ptr<const KdTree> make_kd_tree(const double* points, std::size_t count, int dimension);

}  // namespace iksel
