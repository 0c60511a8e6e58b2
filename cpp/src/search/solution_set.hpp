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
      : model_(model), dof_(static_cast<std::size_t>(model.dof)) {
    q_.reserve(kMost * dof_);
    others_.reserve(kMost);
  }

  void clear() {
    q_.clear();
    others_.clear();
    replacements_ = 0;
  }

  /// Adds a success, unless one of no larger cost lies nearer than `min_distance` in every joint,
  /// whole turns not counted, or there is no room; those of larger cost that do go, and it takes
  /// the place of the first of them. True if there were none.
  bool add(const Result& solution, double cost, double min_distance) {
    const auto is_near = [&](std::size_t i) {
      return model_.joints.are_near(q(i), solution.q, min_distance);
    };
    const Others others{cost, solution.position_error, solution.rotation_error};
    std::size_t place = size();
    for (std::size_t i = 0; i < size(); ++i) {
      if (!is_near(i)) continue;
      if (cost >= others_[i].cost) return false;
      place = std::min(place, i);
    }
    if (place == size()) {
      if (size() == kMost) return false;
      q_.insert(q_.end(), solution.q.data(), solution.q.data() + dof_);
      others_.push_back(others);
      return true;
    }
    ++replacements_;
    std::copy_n(solution.q.data(), dof_, &q_[place * dof_]);
    others_[place] = others;
    for (std::size_t i = size(); --i > place;) {
      if (is_near(i)) erase(i);
    }
    return false;
  }
  /// How often some were replaced by others, so that what is known of single ones no longer holds.
  [[nodiscard]] int replacements() const { return replacements_; }

  /// True if q lies within `radius` of a solution in every joint.
  template <typename Q>
  [[nodiscard]] bool is_near_known(const Q& q, double radius) const {
    for (std::size_t i = 0; i < size(); ++i) {
      if (model_.joints.are_near(this->q(i), q, radius)) return true;
    }
    return false;
  }

  [[nodiscard]] std::size_t size() const { return others_.size(); }
  /// Infinite if there is none.
  [[nodiscard]] double least_cost() const {
    double least = kInfinity;
    for (const Others& each : others_) least = std::min(least, each.cost);
    return least;
  }
  [[nodiscard]] const double* q(std::size_t i) const { return &q_[i * dof_]; }
  [[nodiscard]] JointVector at(std::size_t i) const {
    return Eigen::Map<const Eigen::VectorXd>(q(i), model_.dof);
  }
  /// The success that was added, with its errors.
  [[nodiscard]] Result result(std::size_t i) const {
    Result result;
    result.status = Status::solved;
    result.proof = Proof::answer;
    result.q = at(i);
    result.position_error = others_[i].position_error;
    result.rotation_error = others_[i].rotation_error;
    return result;
  }

 private:
  /// What is kept of a solution besides its joint values.
  struct Others {
    double cost;
    double position_error;  ///< [m]
    double rotation_error;  ///< [rad]
  };

  void erase(std::size_t i) {
    const auto q = q_.begin() + static_cast<std::ptrdiff_t>(i * dof_);
    q_.erase(q, q + static_cast<std::ptrdiff_t>(dof_));
    others_.erase(others_.begin() + static_cast<std::ptrdiff_t>(i));
  }

  const RobotModel& model_;
  std::size_t dof_;
  std::vector<double> q_;
  std::vector<Others> others_;
  int replacements_ = 0;
};

}  // namespace iksel
