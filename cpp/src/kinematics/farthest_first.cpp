// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics/farthest_first.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Core>

#include "base/constants.hpp"

namespace iksel {
namespace {

/// Values of one joint in so many configurations.
constexpr Eigen::Index kBlock = 16;
using Column = Eigen::Array<float, kBlock, 1>;
using Columns = Eigen::Array<float, kBlock, Eigen::Dynamic>;

/// Of each block one column for each joint, whole turns left out; the last is filled up.
Columns in_blocks(const JointSpace& joints, const double* q, Eigen::Index rows) {
  const int dof = joints.dof();
  Columns columns = Columns::Zero(kBlock, (rows + kBlock - 1) / kBlock * dof);
  for (Eigen::Index i = 0; i < rows; ++i) {
    float* row = columns.data() + i / kBlock * dof * kBlock + i % kBlock;
    for (int j = 0; j < dof; ++j, ++q, row += kBlock) {
      *row = static_cast<float>(joints.difference(j, 0.0, *q));
    }
  }
  return columns;
}

}  // namespace

std::vector<std::size_t> farthest_first(const JointSpace& joints, const double* q, std::size_t all,
                                        std::size_t count, double least) {
  const auto rows = static_cast<Eigen::Index>(all);
  const int dof = joints.dof();
  const Columns columns = in_blocks(joints, q, rows);
  const Eigen::Index blocks = columns.cols() / dof;
  Columns nearest = Columns::Constant(kBlock, blocks, std::numeric_limits<float>::max());
  for (Eigen::Index i = rows; i < nearest.size(); ++i) nearest(i) = -1;

  // What a turn is taken off of, where it makes the way shorter.
  Eigen::ArrayXf turn(dof);
  for (int j = 0; j < dof; ++j) {
    turn[j] =
        joints.is_periodic(j) ? static_cast<float>(kTwoPi) : std::numeric_limits<float>::max();
  }
  count = std::min(count, all);
  std::vector<std::size_t> chosen;
  chosen.reserve(count);
  Eigen::Index last = 0;
  Eigen::ArrayXf from(dof);
  while (chosen.size() < count) {
    chosen.push_back(static_cast<std::size_t>(last));
    nearest(last) = -1;
    for (int j = 0; j < dof; ++j) from[j] = columns(last % kBlock, last / kBlock * dof + j);
    Column most = Column::Constant(-1);
    for (Eigen::Index block = 0; block < blocks; ++block) {
      Column distance = Column::Zero();
      for (int j = 0; j < dof; ++j) {
        const Column way = (columns.col(block * dof + j) - from[j]).abs();
        distance = distance.max(way.min((turn[j] - way).abs()));
      }
      distance = nearest.col(block).min(distance);
      nearest.col(block) = distance;
      most = most.max(distance);
    }
    const float farthest = most.maxCoeff();
    if (farthest < static_cast<float>(least)) break;
    last = std::find(nearest.data(), nearest.data() + rows, farthest) - nearest.data();
  }
  return chosen;
}

}  // namespace iksel
