// SPDX-License-Identifier: BSD-3-Clause
// The distinct solutions found so far for one target.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "iksel/result.hpp"
#include "kinematics/joint_space.hpp"
#include "kinematics/robot_model.hpp"

namespace iksel {

/// Images of solutions that are looked at, at most: joints with a wide range have more than time
/// allows.
inline constexpr std::size_t kMostImages = 65536;

/// Memory is taken at construction, none later.
class SolutionSet {
 public:
  /// Solutions kept at most; a search is bounded, and redundant arms have one for every seed.
  static constexpr std::size_t kMost = 1024;

  explicit SolutionSet(const RobotModel& model)
      : model_(model),
        q_(kMost * static_cast<std::size_t>(model.dof)),
        cost_(kMost),
        position_error_(kMost),
        rotation_error_(kMost) {}

  void clear() {
    size_ = 0;
    replacements_ = 0;
  }

  /// Adds a success, unless one of no larger cost lies nearer than `min_distance` in every joint,
  /// whole turns not counted, or there is no room; those of larger cost that do go, and it takes
  /// the place of the first of them. True if there were none.
  bool add(const Result& solution, double cost, double min_distance) {
    const auto is_near = [&](std::size_t i) {
      return model_.joints.are_near(q(i), solution.q, min_distance);
    };
    std::size_t place = size_;
    for (std::size_t i = 0; i < size_; ++i) {
      if (!is_near(i)) continue;
      if (cost >= cost_[i]) return false;
      place = std::min(place, i);
    }
    if (place == size_) {
      if (size_ == kMost) return false;
      put(size_++, solution, cost);
      return true;
    }
    ++replacements_;
    put(place, solution, cost);
    for (std::size_t i = size_; --i > place;) {
      if (is_near(i)) erase(i);
    }
    return false;
  }
  /// How often some were replaced by others, so that what is known of single ones no longer holds.
  [[nodiscard]] int replacements() const { return replacements_; }

  /// True if q lies within `radius` of a solution in every joint.
  template <typename Q>
  [[nodiscard]] bool is_near_known(const Q& q, double radius) const {
    for (std::size_t i = 0; i < size_; ++i) {
      if (model_.joints.are_near(this->q(i), q, radius)) return true;
    }
    return false;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Infinite if there is none.
  [[nodiscard]] double least_cost() const {
    double least = kInfinity;
    for (std::size_t i = 0; i < size_; ++i) least = std::min(least, cost_[i]);
    return least;
  }
  [[nodiscard]] const double* q(std::size_t i) const {
    return &q_[i * static_cast<std::size_t>(model_.dof)];
  }
  [[nodiscard]] JointVector at(std::size_t i) const {
    return Eigen::Map<const Eigen::VectorXd>(q(i), model_.dof);
  }
  /// The success that was added, with its errors.
  [[nodiscard]] Result result(std::size_t i) const {
    Result result;
    result.status = Status::solved;
    result.proof = Proof::answer;
    result.q = at(i);
    result.position_error = position_error_[i];
    result.rotation_error = rotation_error_[i];
    return result;
  }

 private:
  void put(std::size_t i, const Result& solution, double cost) {
    std::copy_n(solution.q.data(), model_.dof, &q_[i * static_cast<std::size_t>(model_.dof)]);
    cost_[i] = cost;
    position_error_[i] = solution.position_error;
    rotation_error_[i] = solution.rotation_error;
  }

  void erase(std::size_t i) {
    const auto dof = static_cast<std::size_t>(model_.dof);
    const auto close_gap = [&](std::vector<double>& values, std::size_t each) {
      const auto gap = values.begin() + static_cast<std::ptrdiff_t>(i * each);
      std::copy(gap + static_cast<std::ptrdiff_t>(each),
                values.begin() + static_cast<std::ptrdiff_t>(size_ * each), gap);
    };
    close_gap(q_, dof);
    close_gap(cost_, 1);
    close_gap(position_error_, 1);
    close_gap(rotation_error_, 1);
    --size_;
  }

  const RobotModel& model_;
  std::vector<double> q_;
  std::vector<double> cost_;
  std::vector<double> position_error_;  ///< [m]
  std::vector<double> rotation_error_;  ///< [rad]
  std::size_t size_ = 0;
  int replacements_ = 0;
};

}  // namespace iksel
