// SPDX-License-Identifier: BSD-3-Clause
#include "scene/point_grid.hpp"

#include <cmath>
#include <limits>

namespace iksel {
namespace {

/// Of cells smaller than a link's spheres there are many to look at [m].
constexpr double kLeastEdge = 0.02;
/// Cells farther than this along an axis are not looked at; the square is held to that of this,
/// which says less than it would but nothing wrong.
constexpr int kWindow = 11;

/// At least so far apart are points in cells whose numbers differ by k, squared.
constexpr int gap2(int k) {
  const int between = k < 0 ? -k - 1 : k - 1;
  return between > 0 ? between * between : 0;
}
// The sums that come up fit into a byte.
static_assert(kWindow * kWindow + gap2(kWindow) < 256, "sums of squares");

}  // namespace

PointGrid::PointGrid(const PointCloud& points)
    : lower_(points.colwise().minCoeff().transpose()),
      upper_(points.colwise().maxCoeff().transpose()) {
  size_cells(upper_ - lower_);
  sort_points(points);
  measure_distances();
}

void PointGrid::size_cells(const Eigen::Vector3d& extent) {
  edge_ = std::max(kLeastEdge, extent.maxCoeff() / 255);
  const auto cells = [&] {
    double product = 1;
    for (const double length : extent) product *= std::floor(length / edge_) + 1;
    return product;
  };
  while (cells() > 1 << 20) edge_ *= 1.1;
  count_ = (extent / edge_).array().cast<int>() + 1;
}

PointGrid::Cell PointGrid::cell_of(const Eigen::Vector3d& c) const {
  Cell cell;
  for (int i = 0; i < 3; ++i) {
    const int last = count_[i] - 1;
    const double place = (c[i] - lower_[i]) / edge_;
    cell[i] = place < last ? static_cast<int>(std::max(place, 0.0)) : last;
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
  away2_.resize(first_.size() - 1);
  for (std::size_t i = 0; i < away2_.size(); ++i) {
    away2_[i] = first_[i + 1] > first_[i] ? 0 : static_cast<std::uint8_t>(kWindow * kWindow);
  }
  // One axis after the other: the least of a sum is that of the least sums along each.
  std::size_t inner = 1;
  for (const int count : count_) {
    measure_along(inner, static_cast<std::size_t>(count));
    inner *= static_cast<std::size_t>(count);
  }
}

void PointGrid::measure_along(std::size_t inner, std::size_t count) {
  const std::vector<std::uint8_t> before = away2_;
  const std::size_t row = inner * count;
  for (std::size_t start = 0; start < away2_.size(); start += row) {
    for (int k = -kWindow; k <= kWindow; ++k) {
      const auto steps = static_cast<std::size_t>(k < 0 ? -k : k);
      if (steps >= count) continue;
      const std::size_t length = (count - steps) * inner;
      const std::uint8_t* from = &before[start + (k > 0 ? steps * inner : 0)];
      std::uint8_t* to = &away2_[start + (k < 0 ? steps * inner : 0)];
      const auto more = static_cast<std::uint8_t>(gap2(k));
      for (std::size_t i = 0; i < length; ++i) {
        const auto through = static_cast<std::uint8_t>(from[i] + more);
        to[i] = through < to[i] ? through : to[i];
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
  // Cells are where rounding puts their points.
  const double away2 = away2_[index(cell[0], cell[1], cell[2])] * edge_ * edge_;
  return away2 * (1 - kRounding) <= radius * radius;
}

bool PointGrid::touches(const Eigen::Vector3d& c, double radius, double& clearance) const {
  if (!may_touch(c, radius)) return false;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius);
  const Cell from = cell_of(c - reach);
  const Cell to = cell_of(c + reach);
  const double square = radius * radius;
  for (int z = from[2]; z <= to[2]; ++z) {
    const double beyond_z = square - gap2_to(c, 2, z);
    for (int y = from[1]; y <= to[1]; ++y) {
      if (gap2_to(c, 1, y) > beyond_z) continue;
      const std::uint32_t end = first_[index(to[0], y, z) + 1];
      double least = std::numeric_limits<double>::infinity();
      for (std::uint32_t i = first_[index(from[0], y, z)]; i < end; ++i) {
        const auto& p = points_[i];
        const double dx = p[0] - c[0];
        const double dy = p[1] - c[1];
        const double dz = p[2] - c[2];
        least = std::min(least, dx * dx + dy * dy + dz * dz);
      }
      if (!(least <= square)) continue;
      clearance = least - square;
      return true;
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
