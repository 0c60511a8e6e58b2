// SPDX-License-Identifier: BSD-3-Clause
// Newton's method towards what is closest: its derivatives, and where it ends.
#include <gtest/gtest.h>

#include "goal/goal.hpp"
#include "refine/closest_descent.hpp"
#include "robots.hpp"
#include "tasks.hpp"

namespace {

using iksel::Goal;
using iksel::JointVector;
using iksel::Pose;
using iksel::Remainder;
using iksel::Robot;
using iksel::SquareMatrix;
using iksel::TaskSpace;
using iksel::Vector6;

Vector6 some_weights() {
  Vector6 weights;
  weights << 1, 0.5, 2, 0.3, 0.1, 0.2;
  return weights;
}

/// Rotations about all axes weigh the same, for which there is a formula.
Vector6 weights_of_alike_turns() {
  Vector6 weights;
  weights << 1, 0.5, 2, 0.3, 0.3, 0.3;
  return weights;
}

TEST(ClosestDescent, DerivativesAreThoseOfDifferences) {
  for (const char* name : {"ur5e", "panda", "xarm5"}) {
    const Robot& robot = iksel_test::robot(name);
    for (const auto& [task_name, task] : iksel_test::tasks()) {
      const TaskSpace space(task, 1e-6, 1e-6);
      const int cases = iksel_test::cases(20, 5);
      const Eigen::MatrixXd q = robot.random_configurations(2 * cases, iksel_test::seed());
      for (int i = 0; i < cases; ++i) {
        const Pose target = robot.fk(q.row(2 * i));
        const Goal goal(robot.model(), space, target);
        const Vector6 weights = i % 2 == 0 ? some_weights() : weights_of_alike_turns();
        const Remainder remainder(goal, weights);
        const JointVector at = q.row(2 * i + 1);
        JointVector gradient(robot.dof());
        JointVector ignored(robot.dof());
        SquareMatrix second;
        const double value = remainder.value(at, gradient, ignored, &second);
        EXPECT_NEAR(value, remainder.value(at), 1e-12);
        for (int j = 0; j < robot.dof(); ++j) {
          constexpr double kStep = 1e-5;
          JointVector before = at;
          JointVector behind = at;
          before[j] -= kStep;
          behind[j] += kStep;
          JointVector low(robot.dof());
          JointVector high(robot.dof());
          const double slope = (remainder.value(behind) - remainder.value(before)) / (2 * kStep);
          // Where a rotation is half a turn off, or a part at the end of its bounds, it has no
          // second derivative.
          const double scale = 1 + std::abs(gradient[j]) + second.cwiseAbs().maxCoeff();
          if (scale > 50) continue;
          EXPECT_NEAR(gradient[j], slope, 1e-6 * scale) << name << ", " << task_name << ", " << i;
          remainder.value(before, low, ignored);
          remainder.value(behind, high, ignored);
          const JointVector column = (high - low) / (2 * kStep);
          EXPECT_NEAR((second.col(j) - column).cwiseAbs().maxCoeff(), 0, 1e-4 * scale)
              << name << ", " << task_name << ", case " << i << ", joint " << j;
        }
      }
    }
  }
}

TEST(ClosestDescent, EndsWhereNoStepInsideTheLimitsLowersIt) {
  for (const char* name : {"ur5e", "panda", "xarm5"}) {
    const Robot& robot = iksel_test::robot(name);
    const TaskSpace space(iksel::Task{}, 1e-6, 1e-6);
    const int cases = iksel_test::cases(50, 10);
    const Eigen::MatrixXd q = robot.random_configurations(2 * cases, iksel_test::seed());
    for (int i = 0; i < cases; ++i) {
      Pose target = robot.fk(q.row(2 * i));
      target.translation() *= 1.5;
      const Goal goal(robot.model(), space, target);
      const Remainder remainder(goal, some_weights());
      JointVector end = q.row(2 * i + 1);
      int steps = 0;
      const double value = descend_from_seed(remainder, 500, end, steps);
      EXPECT_TRUE(robot.within_limits(end));
      EXPECT_NEAR(value, remainder.value(end), 1e-9 * (1 + value));
      EXPECT_LE(value, remainder.value(q.row(2 * i + 1)));
      for (int j = 0; j < robot.dof(); ++j) {
        for (const double step : {1e-4, -1e-4}) {
          JointVector beside = end;
          beside[j] += step;
          if (!robot.within_limits(beside)) continue;
          EXPECT_GE(remainder.value(beside), value * (1 - 1e-6)) << name << ", case " << i;
        }
      }
    }
  }
}

}  // namespace
