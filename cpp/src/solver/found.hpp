// SPDX-License-Identifier: BSD-3-Clause
// The distinct solutions found so far for one target.
#pragma once

#include <algorithm>
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
      : model_(model), q_(kMost * static_cast<std::size_t>(model.dof)), cost_(kMost) {}

  void clear() { size_ = 0; }

  /// Adds q, a solution inside the limits, unless one lies nearer than `min_distance` in every
  /// joint, copies by whole turns not counted; or there is no room. Of two that lie so near, the
  /// one of smaller cost stays, at the place of the first.
  void add(const JointVector& q, double cost, double min_distance) {
    for (std::size_t i = 0; i < size_; ++i) {
      if (distance_without_turns(model_, this->q(i), q, min_distance) >= min_distance) continue;
      if (cost < cost_[i]) put(i, q, cost);
      return;
    }
    if (size_ == kMost) return;
    put(size_++, q, cost);
  }

  /// True if q lies within `radius` of a solution in every
  /// joint.
  template <typename Q>
  [[nodiscard]] bool is_near_known(const Q& q, double radius) const {
    for (std::size_t i = 0; i < size_; ++i) {
      if (distance_without_turns(model_, this->q(i), q, radius) < radius) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const double* q(std::size_t i) const {
    return &q_[i * static_cast<std::size_t>(model_.dof)];
  }
  [[nodiscard]] JointVector at(std::size_t i) const {
    return Eigen::Map<const Eigen::VectorXd>(q(i), model_.dof);
  }

 private:
  void put(std::size_t i, const JointVector& q, double cost) {
    std::copy_n(q.data(), model_.dof, &q_[i * static_cast<std::size_t>(model_.dof)]);
    cost_[i] = cost;
  }

  const ChainModel& model_;
  std::vector<double> q_;
  std::vector<double> cost_;
  std::size_t size_ = 0;
};

}  // namespace iksel
