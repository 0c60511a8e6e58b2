// SPDX-License-Identifier: BSD-3-Clause
// What a search for several tips has to reach: the goal of each, one below the other.
#pragma once

#include <vector>

#include "goal/goal.hpp"
#include "iksel/tree_solver.hpp"
#include "tree/tree_model.hpp"

namespace iksel {

class StackedGoal {
 public:
  /// A task and a target, T_base_tcp, for each tip. All must outlive this.
  StackedGoal(const TreeModel& model, const std::vector<TaskSpace>& tasks,
              const std::vector<Pose>& targets)
      : model_(model), tasks_(tasks), targets_(targets) {}

  [[nodiscard]] const TreeModel& model() const { return model_; }
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

  [[nodiscard]] const JointSpace& joints() const { return model_.joints; }
  /// Six rows for each tip.
  using Linear = LinearGoal<Eigen::Dynamic, 6 * kMaxTips>;
  /// As Goal::linearize and Goal::is_reached, of all tips.
  void linearize(const JointVector& q, bool exact, Linear& at) const;
  [[nodiscard]] bool is_reached(const Linear::Vector& missing, double part) const;
  /// Computes all errors of q anew; only if q reaches every target inside the limits, it becomes
  /// the result.
  bool check(const JointVector& q, TreeResult& result) const;

 private:
  const TreeModel& model_;
  const std::vector<TaskSpace>& tasks_;
  const std::vector<Pose>& targets_;
};

}  // namespace iksel
