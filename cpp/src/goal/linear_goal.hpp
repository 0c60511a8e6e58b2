// SPDX-License-Identifier: BSD-3-Clause
// A goal to first order around a configuration, as one step of an iteration sees it.
#pragma once

#include "iksel/types.hpp"

namespace iksel {

/// lower <= deviation + J step <= upper. `kRows` may be dynamic, with `kMostRows` at most.
template <int kRows, int kMostRows>
struct LinearGoal {
  using Vector = Eigen::Matrix<double, kRows, 1, Eigen::ColMajor, kMostRows, 1>;
  using Jacobian =
      Eigen::Matrix<double, kRows, Eigen::Dynamic, Eigen::ColMajor, kMostRows, kMaxDof>;

  Jacobian J;
  Vector deviation;
  Vector lower, upper;
  Vector missing;  ///< from the deviation to the bounds

  /// Counts lengths, the first three of each six rows, in that unit [m].
  void to_unit(double unit) {
    if (unit == 1) return;
    for (Eigen::Index row = 0; row < J.rows(); row += 6) {
      J.template middleRows<3>(row) /= unit;
      for (Vector* each : {&deviation, &lower, &upper, &missing}) {
        each->template segment<3>(row) /= unit;
      }
    }
  }
  [[nodiscard]] bool is_fixed(Eigen::Index row) const { return lower[row] == upper[row]; }
};

}  // namespace iksel
