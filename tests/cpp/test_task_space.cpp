// SPDX-License-Identifier: BSD-3-Clause
// What the deviations from a task are.
#include <gtest/gtest.h>

#include <cmath>
#include <iksel/iksel.hpp>

#include "base/random.hpp"
#include "goal/task_space.hpp"
#include "robots.hpp"
#include "task_errors.hpp"
#include "tasks.hpp"

namespace {

using iksel::Axis;
using iksel::JacobianMatrix;
using iksel::JointVector;
using iksel::Pose;
using iksel::Random;
using iksel::Robot;
using iksel::Task;
using iksel::TaskFrame;
using iksel::TaskSpace;
using iksel::Vector6;
using iksel_test::angle_between;
using iksel_test::kInfinity;
using iksel_test::tasks;

TaskSpace space_of(const Task& task) { return {task, 1e-6, 1e-6}; }

/// Bounds of every kind, about either frame: fixed, symmetric, one-sided and free.
Task random_task(Random& random) {
  Task task;
  task.frame = random.uniform(0, 1) < 0.5 ? TaskFrame::tool : TaskFrame::base;
  const auto set = [&](double widest, double& lower, double& upper) {
    const double kind = random.uniform(0, 4);
    lower = kind < 1 ? 0 : -random.uniform(0, widest);
    upper = kind < 1 ? 0 : kind < 2 ? -lower : kind < 3 ? 0 : random.uniform(0, widest);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    set(1, task.position_lower[k], task.position_upper[k]);
    set(1, task.rotation_lower[k], task.rotation_upper[k]);
    if (random.uniform(0, 1) > 0.3) continue;
    task.rotation_lower[k] = -kInfinity;
    task.rotation_upper[k] = kInfinity;
  }
  return task;
}

TEST(TaskSpace, FindsTheDeviationThatAPoseWasMadeWith) {
  const Robot& robot = iksel_test::robot("panda");
  Random random(iksel_test::seed());
  for (const auto& [name, task] : tasks()) {
    const TaskSpace space = space_of(task);
    for (int i = 0; i < iksel_test::cases(300); ++i) {
      const Pose target = robot.fk(robot.random_configurations(1, random.next()).row(0));
      Vector6 d;
      for (int k = 0; k < 3; ++k) d[k] = random.uniform(-1, 1);
      // Any twist, and swings or rotation vectors shorter than pi.
      for (int k = 3; k < 6; ++k) d[k] = random.uniform(-1.7, 1.7);
      if (space.rotation_is_free()) d.tail<3>().setZero();
      const Vector6 found = space.deviation(target, space.pose_at(target, d));
      EXPECT_LT((found - d).norm(), 1e-12) << name << ", seed " << iksel_test::seed();
    }
  }
}

TEST(TaskSpace, JacobianIsTheDerivativeOfTheDeviation) {
  Random random(iksel_test::seed());
  for (const char* robot_name : {"panda", "xarm5", "cvr038"}) {
    const Robot& robot = iksel_test::robot(robot_name);
    for (const auto& [name, task] : tasks()) {
      const TaskSpace space = space_of(task);
      for (int i = 0; i < iksel_test::cases(100); ++i) {
        const Eigen::MatrixXd q = robot.random_configurations(2, random.next());
        const Pose target = robot.fk(q.row(0));
        JacobianMatrix J = robot.jacobian(q.row(1));
        const Vector6 d = space.deviation(target, robot.fk(q.row(1)), J);
        EXPECT_LT((d - space.deviation(target, robot.fk(q.row(1)))).norm(), 1e-12);
        constexpr double kStep = 1e-6;
        for (int j = 0; j < robot.dof(); ++j) {
          JointVector above = q.row(1);
          JointVector below = q.row(1);
          above[j] += kStep;
          below[j] -= kStep;
          const Vector6 after = space.deviation(target, robot.fk(above));
          const Vector6 before = space.deviation(target, robot.fk(below));
          // Across a half turn the numbers jump; close to a reversed axis they run away.
          if ((after - before).norm() > 1e-3) continue;
          const Vector6 difference = (after - before) / (2 * kStep);
          EXPECT_LT((J.col(j) - difference).norm(), 1e-6 * (1 + difference.norm()))
              << robot_name << ", " << name << ", joint " << j << ", case " << i << ", seed "
              << iksel_test::seed();
        }
      }
    }
  }
}

TEST(TaskSpace, FreeSpinMeasuresTheAngleBetweenTheAxes) {
  const Robot& robot = iksel_test::robot("ur3");
  const Eigen::MatrixXd q = robot.random_configurations(2 * iksel_test::cases(1000), 5);
  for (Eigen::Index i = 0; i + 1 < q.rows(); i += 2) {
    const Pose target = robot.fk(q.row(i));
    const Pose pose = robot.fk(q.row(i + 1));
    for (int axis = 0; axis < 3; ++axis) {
      double position = 0;
      double rotation = 0;
      space_of(Task::free_spin(static_cast<Axis>(axis))).measure(target, pose, position, rotation);
      EXPECT_NEAR(position, (target.translation() - pose.translation()).norm(), 1e-12);
      EXPECT_NEAR(rotation, angle_between(target.linear().col(axis), pose.linear().col(axis)),
                  1e-12);
      // Upright: the base's axis as the tool sees it.
      space_of(Task::upright(static_cast<Axis>(axis))).measure(target, pose, position, rotation);
      EXPECT_NEAR(
          rotation,
          angle_between(target.linear().row(axis).transpose(), pose.linear().row(axis).transpose()),
          1e-12);
    }
  }
}

TEST(TaskSpace, AgreesWithTheDefinitionOfATask) {
  const Robot& robot = iksel_test::robot("ur3");
  Random random(iksel_test::seed());
  for (int i = 0; i < iksel_test::cases(20'000); ++i) {
    const Task task = random_task(random);
    const Eigen::MatrixXd q = robot.random_configurations(2, random.next());
    const Pose target = robot.fk(q.row(0));
    Pose pose = robot.fk(q.row(1));
    if (i % 4 == 0) {  // close by, as answers are
      Vector6 d;
      for (int k = 0; k < 6; ++k) d[k] = random.uniform(-1e-6, 1e-6);
      pose = space_of(Task::pose()).pose_at(target, d);
    }
    const Vector6 outside =
        iksel_test::outside_of(task, iksel_test::task_deviation(task, target, pose));
    double position = 0;
    double rotation = 0;
    space_of(task).measure(target, pose, position, rotation);
    EXPECT_NEAR(position, outside.head<3>().norm(), 1e-12)
        << "case " << i << ", seed " << iksel_test::seed();
    // Near a half turn the axis, and so what is outside, is only as good as its distance from it.
    EXPECT_NEAR(rotation, outside.tail<3>().norm(), 1e-9)
        << "case " << i << ", seed " << iksel_test::seed();
  }
}

TEST(TaskSpace, AFullPoseIsMeasuredAsEverywhereElse) {
  const Robot& robot = iksel_test::robot("ur3");
  const Eigen::MatrixXd q = robot.random_configurations(200, 6);
  for (Eigen::Index i = 0; i + 1 < q.rows(); i += 2) {
    double position = 0;
    double rotation = 0;
    const Pose target = robot.fk(q.row(i));
    const Pose pose = robot.fk(q.row(i + 1));
    space_of(Task::pose()).measure(target, pose, position, rotation);
    const Vector6 e = iksel::pose_error(target, pose);
    EXPECT_NEAR(position, e.head<3>().norm(), 1e-12);
    EXPECT_NEAR(rotation, e.tail<3>().norm(), 1e-12);
  }
}

TEST(TaskSpace, DistanceFromAPointIsTheLeastOverTheBox) {
  Random random(iksel_test::seed());
  const Robot& robot = iksel_test::robot("ur3");
  for (const TaskFrame frame : {TaskFrame::base, TaskFrame::tool}) {
    const TaskSpace space = space_of(Task::box({0.1, 0.2, 0.3}, {0, 0, 0}, frame));
    const Pose target = robot.fk(robot.random_configurations(1, 7).row(0));
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d point(random.uniform(-1, 1), random.uniform(-1, 1),
                                  random.uniform(-1, 1));
      const double distance = space.distance_from(target, point);
      double least = kInfinity;
      for (int k = 0; k < 20'000; ++k) {
        Vector6 d = Vector6::Zero();
        for (int j = 0; j < 3; ++j) d[j] = random.uniform(space.lower()[j], space.upper()[j]);
        least = std::min(least, (space.pose_at(target, d).translation() - point).norm());
      }
      EXPECT_LE(distance, least + 1e-12);
      EXPECT_NEAR(distance, least, 0.03);
    }
  }
}

}  // namespace
