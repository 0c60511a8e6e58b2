// SPDX-License-Identifier: BSD-3-Clause
// The distinct solutions found so far for one target.
#pragma once

#include <cstddef>
#include <vector>

#include "kinematics/chain_model.hpp"
#include "solver/joint_move.hpp"

namespace iksel {

/// Memory is taken at construction, none later.
class Found {
 public:
  /// Solutions kept at most; a search is bounded, and redundant arms have one for every seed.
  static constexpr std::size_t kMost = 1024;

  explicit Found(const ChainModel& model)
      : model_(model), q_(kMost * static_cast<std::size_t>(model.dof)) {}

  void clear() { size_ = 0; }

  /// Adds q, a solution inside the limits, unless one lies nearer than `min_distance` in every
  /// joint, copies by whole turns not counted; or there is no room. Whether it was added.
  bool add(const JointVector& q, double min_distance) {
    if (size_ == kMost) return false;
    for (std::size_t i = 0; i < size_; ++i) {
      if (distance_without_turns(model_, this->q(i), q.data()) < min_distance) return false;
    }
    const auto dof = static_cast<std::size_t>(model_.dof);
    for (std::size_t j = 0; j < dof; ++j) q_[size_ * dof + j] = q[static_cast<int>(j)];
    ++size_;
    return true;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const double* q(std::size_t i) const {
    return &q_[i * static_cast<std::size_t>(model_.dof)];
  }
  [[nodiscard]] JointVector at(std::size_t i) const {
    return Eigen::Map<const Eigen::VectorXd>(q(i), model_.dof);
  }

 private:
  const ChainModel& model_;
  std::vector<double> q_;
  std::size_t size_ = 0;
};

}  // namespace iksel
