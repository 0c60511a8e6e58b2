// SPDX-License-Identifier: BSD-3-Clause
#include "scene/point_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace iksel {
namespace {

/// Of cells smaller than a link's spheres there are many to look at [m].
constexpr double kLeastEdge = 0.02;
constexpr double kMostCells = 1 << 20;
/// Counts beyond are held to it, which says less than they would but nothing wrong.
constexpr int kFarthest = 255;

}  // namespace

PointGrid::PointGrid(const PointCloud& points)
    : lower_(points.colwise().minCoeff().transpose()),
      upper_(points.colwise().maxCoeff().transpose()) {
  size_cells(upper_ - lower_);
  sort_points(points);
  measure_distances();
}

void PointGrid::size_cells(const Eigen::Vector3d& extent) {
  // Cells as large as the largest extent are few.
  edge_ = std::max(kLeastEdge, extent.maxCoeff() / kFarthest);
  const auto cells = [&] {
    double product = 1;
    for (const double length : extent) product *= std::floor(length / edge_) + 1;
    return product;
  };
  while (cells() > kMostCells) edge_ *= 1.1;
  for (int i = 0; i < 3; ++i) {
    count_[static_cast<std::size_t>(i)] = static_cast<int>(extent[i] / edge_) + 1;
  }
}

PointGrid::Cell PointGrid::cell_of(const Eigen::Vector3d& c) const {
  Cell cell;
  for (int i = 0; i < 3; ++i) {
    const int last = count_[static_cast<std::size_t>(i)] - 1;
    const double place = (c[i] - lower_[i]) / edge_;
    cell[static_cast<std::size_t>(i)] =
        place < last ? static_cast<int>(std::max(place, 0.0)) : last;
  }
  return cell;
}

void PointGrid::sort_points(const PointCloud& points) {
  const auto cell = [&](Eigen::Index row) {
    const Cell at = cell_of(points.row(row));
    return index(at[0], at[1], at[2]);
  };
  const std::size_t cells = index(count_[0] - 1, count_[1] - 1, count_[2] - 1) + 1;
  first_.assign(cells + 1, 0);
  for (Eigen::Index row = 0; row < points.rows(); ++row) ++first_[cell(row) + 1];
  for (std::size_t i = 0; i < cells; ++i) first_[i + 1] += first_[i];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  points_.resize(static_cast<std::size_t>(points.rows()));
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    points_[next[cell(row)]++] = {points(row, 0), points(row, 1), points(row, 2)};
  }
}

void PointGrid::measure_distances() {
  // In two passes, from neighbours that come before and after: exact for this distance (Rosenfeld
  // and Pfaltz, "Distance functions on digital pictures", 1968).
  away_.assign(first_.size() - 1, kFarthest);
  const auto relax = [&](int x, int y, int z, int side) {
    std::uint8_t& here = away_[index(x, y, z)];
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int order = (dz * 3 + dy) * 3 + dx;
          if (order * side >= 0) continue;
          const int i = x + dx;
          const int j = y + dy;
          const int k = z + dz;
          if (i < 0 || j < 0 || k < 0 || i >= count_[0] || j >= count_[1] || k >= count_[2]) {
            continue;
          }
          const int through = std::min(away_[index(i, j, k)] + 1, kFarthest);
          here = static_cast<std::uint8_t>(std::min<int>(here, through));
        }
      }
    }
  };
  for (std::size_t i = 0; i < away_.size(); ++i) {
    if (first_[i + 1] > first_[i]) away_[i] = 0;
  }
  for (const int side : {1, -1}) {
    const auto place = [&](int i, std::size_t axis) { return side > 0 ? i : count_[axis] - 1 - i; };
    for (int z = 0; z < count_[2]; ++z) {
      for (int y = 0; y < count_[1]; ++y) {
        for (int x = 0; x < count_[0]; ++x) relax(place(x, 0), place(y, 1), place(z, 2), side);
      }
    }
  }
}

bool PointGrid::may_touch(const Eigen::Vector3d& c, double radius) const {
  double outside = 0;  // squared distance from the grid
  for (int i = 0; i < 3; ++i) {
    const double d = std::max({lower_[i] - c[i], c[i] - upper_[i], 0.0});
    outside += d * d;
  }
  if (outside > radius * radius) return false;
  const Cell cell = cell_of(c);
  return (away_[index(cell[0], cell[1], cell[2])] - 1) * edge_ <= radius;
}

bool PointGrid::touches(const Eigen::Vector3d& c, double radius) const {
  if (!may_touch(c, radius)) return false;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius);
  const Cell from = cell_of(c - reach);
  const Cell to = cell_of(c + reach);
  for (int z = from[2]; z <= to[2]; ++z) {
    for (int y = from[1]; y <= to[1]; ++y) {
      const std::uint32_t end = first_[index(to[0], y, z) + 1];
      for (std::uint32_t i = first_[index(from[0], y, z)]; i < end; ++i) {
        const auto& p = points_[i];
        const double x = p[0] - c[0];
        const double dy = p[1] - c[1];
        const double dz = p[2] - c[2];
        if (x * x + dy * dy + dz * dz <= radius * radius) return true;
      }
    }
  }
  return false;
}

double PointGrid::nearest(const Eigen::Vector3d& c) const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& p : points_) {
    least = std::min(least, (Eigen::Map<const Eigen::Vector3d>(p.data()) - c).squaredNorm());
  }
  return std::sqrt(least);
}

}  // namespace iksel
