// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/farthest_first.hpp"

#include <algorithm>
#include <limits>

#include "base/constants.hpp"

namespace iksel {

std::vector<std::size_t> farthest_first(const lanes::LaneKernels& kernels, const JointSpace& joints,
                                        const double* q, std::size_t all, std::size_t count,
                                        double least) {
  const auto dof = static_cast<std::size_t>(joints.dof());
  const std::size_t blocks = (all + lanes::kBlock - 1) / lanes::kBlock;
  // Whole turns are left out, which single precision would take for more than they are.
  std::vector<float> columns(blocks * dof * lanes::kBlock);
  const auto at = [&](std::size_t i, std::size_t j) -> float& {
    return columns[(i / lanes::kBlock * dof + j) * lanes::kBlock + i % lanes::kBlock];
  };
  for (std::size_t i = 0; i < all; ++i) {
    for (std::size_t j = 0; j < dof; ++j, ++q) {
      at(i, j) = static_cast<float>(joints.difference(static_cast<int>(j), 0.0, *q));
    }
  }
  // Those that are there not, or were taken, are never the farthest.
  std::vector<float> nearest(blocks * lanes::kBlock, -1);
  std::fill_n(nearest.begin(), all, std::numeric_limits<float>::max());
  float per_turn[lanes::kMaxJoints];
  for (int j = 0; j < joints.dof(); ++j) {
    per_turn[j] = joints.is_periodic(j) ? static_cast<float>(1 / kTwoPi) : 0;
  }
  float from[lanes::kMaxJoints];
  std::vector<std::size_t> chosen;
  count = std::min(count, all);
  chosen.reserve(count);
  std::size_t last = 0;
  while (chosen.size() < count) {
    chosen.push_back(last);
    nearest[last] = -1;
    for (std::size_t j = 0; j < dof; ++j) from[j] = at(last, j);
    kernels.add_known(joints.dof(), per_turn, from, columns.data(), static_cast<int>(blocks),
                      static_cast<std::ptrdiff_t>(dof * lanes::kBlock), nearest.data());
    last = static_cast<std::size_t>(
        kernels.find_largest(static_cast<int>(nearest.size()), nearest.data()));
    if (nearest[last] < static_cast<float>(least)) break;
  }
  return chosen;
}

}  // namespace iksel
