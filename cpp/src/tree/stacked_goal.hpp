// SPDX-License-Identifier: BSD-3-Clause
// What a search for several tips has to reach: the goal of each, one below the other.
#pragma once

#include <vector>

#include "goal/goal.hpp"
#include "iksel/tree_solver.hpp"
#include "tree/tree_model.hpp"

namespace iksel {

inline constexpr int kMaxRows = 6 * kMaxTips + kMaxCoupledLimits;
/// Six parts for each tip, and a sum for each coupled limit.
using StackedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxRows, 1>;
using StackedJacobian =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxRows, kMaxDof>;

class StackedGoal {
 public:
  /// A task and a target, T_base_tcp, for each tip. All must outlive this.
  StackedGoal(const TreeModel& model, const std::vector<TaskSpace>& tasks,
              const std::vector<Pose>& targets)
      : model_(model), tasks_(tasks), targets_(targets) {
    aim_lower_.resize(rows());
    aim_upper_.resize(rows());
    for (int i = 0; i < model.tip_count(); ++i) {
      aim_lower_.segment<6>(6 * i) = task(i).aim_lower();
      aim_upper_.segment<6>(6 * i) = task(i).aim_upper();
    }
    for (int i = 0; i < coupled_count(); ++i) {
      aim_lower_[6 * model.tip_count() + i] = coupled(i).lower + beside(i);
      aim_upper_[6 * model.tip_count() + i] = coupled(i).upper - beside(i);
    }
  }

  [[nodiscard]] const TreeModel& model() const { return model_; }
  [[nodiscard]] int rows() const { return 6 * model_.tip_count() + coupled_count(); }
  [[nodiscard]] const TaskSpace& task(int tip) const {
    return tasks_[static_cast<std::size_t>(tip)];
  }
  [[nodiscard]] const Pose& target(int tip) const {
    return targets_[static_cast<std::size_t>(tip)];
  }
  /// That of one tip's chain.
  [[nodiscard]] Goal of(int tip) const {
    return {model_.tip(tip).chain.model(), task(tip), target(tip)};
  }

  /// Bounds of the deviation that iterations aim at, of all tips, and of the coupled sums.
  [[nodiscard]] const StackedVector& aim_lower() const { return aim_lower_; }
  [[nodiscard]] const StackedVector& aim_upper() const { return aim_upper_; }

  /// The deviation of each tip from its target (TaskSpace::deviation), then the coupled sums; and
  /// their Jacobian.
  void linearize(const JointVector& q, StackedVector& deviation, StackedJacobian& J) const;
  /// Whether what is missing of each tip's deviation is within `part` of its tolerances, and the
  /// coupled sums lie inside their limits.
  [[nodiscard]] bool is_reached(const StackedVector& missing, double part) const;
  /// Computes all errors of q anew; only if q reaches every target inside the limits, it becomes
  /// the result.
  bool check(const JointVector& q, TreeResult& result) const;

 private:
  [[nodiscard]] int coupled_count() const { return static_cast<int>(model_.joints.coupled.size()); }
  [[nodiscard]] const CoupledRow& coupled(int i) const {
    return model_.joints.coupled[static_cast<std::size_t>(i)];
  }
  /// So far inside of a coupled limit is what iterations aim at.
  [[nodiscard]] double beside(int i) const { return 1e3 * coupled(i).rounding; }

  const TreeModel& model_;
  const std::vector<TaskSpace>& tasks_;
  const std::vector<Pose>& targets_;
  StackedVector aim_lower_, aim_upper_;
};

}  // namespace iksel
