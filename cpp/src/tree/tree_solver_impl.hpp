// SPDX-License-Identifier: BSD-3-Clause
// What a TreeSolver holds, and its calls for valid input.
#pragma once

#include <vector>

#include "base/work.hpp"
#include "iksel/tree_solver.hpp"
#include "tree/arm_search.hpp"
#include "tree/stacked_refiner.hpp"

namespace iksel {

struct TreeSolver::Impl {
  Impl(const TreeRobot& robot_in, const SolverOptions& options_in);

  [[nodiscard]] const TreeModel& model() const { return robot.model(); }
  /// Throws InvalidArgumentError unless the request fits the robot.
  void check(const TreeRequest& request) const;
  /// Throws InvalidArgumentError about a configuration of another size, not finite, or so large
  /// that a double cannot tell poses apart.
  void check_near(const JointVector& near) const;
  /// The nearest rigid poses. Throws InvalidArgumentError unless there is one for each tip.
  [[nodiscard]] std::vector<Pose> check_targets(const std::vector<Pose>& T_base_tip) const;
  [[nodiscard]] std::vector<TaskSpace> tasks_of(const TreeRequest& request) const;
  /// The targets are rigid.
  [[nodiscard]] TreeResult solve(const std::vector<Pose>& targets,
                                 const TreeRequest& request) const;

  void find_nearest(const StackedGoal& goal, const TreeRequest& request, ArmSearch& arms,
                    StackedRefiner& refiner, Work& work, TreeResult& result) const;

  TreeRobot robot;
  SolverOptions options;
  std::vector<TipSolvers> solvers;
};

}  // namespace iksel
