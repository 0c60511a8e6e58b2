// SPDX-License-Identifier: BSD-3-Clause
// Points in the cells of a grid, each of which knows at least how far away the nearest point is.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/constants.hpp"
#include "iksel/scene.hpp"

namespace iksel {

class PointGrid {
 public:
  explicit PointGrid(const PointCloud& points);

  /// Whether a point may lie within `radius` of c: never false where one does.
  [[nodiscard]] bool may_touch(const Eigen::Vector3d& c, double radius) const;
  /// Whether one does; then `clearance` is distance^2 - radius^2 of one that is about the nearest
  /// [m^2].
  [[nodiscard]] bool touches(const Eigen::Vector3d& c, double radius, double& clearance) const;
  /// Distance of the nearest point [m].
  [[nodiscard]] double nearest(const Eigen::Vector3d& c) const;

 private:
  using Cell = Eigen::Array3i;
  /// The cell that holds c, or is nearest to it.
  [[nodiscard]] Cell cell_of(const Eigen::Vector3d& c) const;
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>((z * count_[1] + y) * count_[0] + x);
  }
  void size_cells(const Eigen::Vector3d& extent);
  void sort_points(const PointCloud& points);
  void measure_distances();
  /// The same along one axis: of rows of `count` cells, `inner` apart.
  void measure_along(std::size_t inner, std::size_t count);
  /// At least how far c is from the points of cell number `cell` along an axis, squared [m^2].
  /// Cells are where rounding puts their points.
  [[nodiscard]] double gap2_to(const Eigen::Vector3d& c, int axis, int cell) const {
    const double low = lower_[axis] + edge_ * cell - c[axis];
    const double gap = std::max({low, -low - edge_, 0.0}) - kRounding * edge_;
    return gap > 0 ? gap * gap : 0;
  }

  Eigen::Matrix<double, 3, 1, Eigen::DontAlign> lower_, upper_;  ///< corners [m]
  double edge_ = 0;                                              ///< of a cell [m]
  Cell count_;                                                   ///< along each axis
  /// Those of cell i are points_[first_[i]] to points_[first_[i + 1] - 1].
  std::vector<std::uint32_t> first_;
  std::vector<std::array<double, 3>> points_;
  /// At least so far is any place in a cell from the nearest point, squared [edges^2].
  std::vector<std::uint8_t> away2_;
};

}  // namespace iksel
