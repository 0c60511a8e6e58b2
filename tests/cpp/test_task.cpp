// SPDX-License-Identifier: BSD-3-Clause
// That solving reaches tasks, measured by KDL's FK and by the formulas of task_errors.hpp.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "goal/task_space.hpp"
#include "iksel/iksel.hpp"
#include "robots.hpp"
#include "task_errors.hpp"
#include "tasks.hpp"

namespace {

using iksel::Axis;
using iksel::JointVector;
using iksel::Pose;
using iksel::Random;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolverOptions;
using iksel::Status;
using iksel::Task;
using iksel::TaskSpace;
using iksel::Vector6;
using iksel_test::kInfinity;
using iksel_test::kPi;
using iksel_test::tasks;

/// What a task asks for, by formulas that share nothing with the library's.
void expect_reached(const Task& task, const Pose& target, const Pose& pose, const char* what) {
  const Vector6 outside =
      iksel_test::outside_of(task, iksel_test::task_deviation(task, target, pose));
  EXPECT_LE(outside.head<3>().norm(), 1e-6 + 1e-12) << what;
  EXPECT_LE(outside.tail<3>().norm(), 1e-6 + 1e-12) << what;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    // Where there is room, answers lie within the bounds, not only within the tolerance.
    if (task.position_upper[k] - task.position_lower[k] <= 1e-5) continue;
    EXPECT_NEAR(outside[i], 0, 1e-12) << what;
  }
}

class TasksOfRobots : public testing::TestWithParam<std::string> {};

TEST_P(TasksOfRobots, ReachEveryTaskFromReachableTargets) {
  const Robot& robot = iksel_test::robot(GetParam());
  iksel_test::Judge judge(robot);
  const iksel::Database database = iksel::Database::build(robot);
  const int cases = iksel_test::cases(200);
  const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
  for (const auto& [name, task] : tasks()) {
    SolverOptions options;
    options.task = task;
    const Solver solver(robot, options, database);
    int solved = 0;
    for (int i = 0; i < cases; ++i) {
      const Pose target = judge.fk(q.row(i));
      const Result result = solver.solve(target);
      if (!result.success()) continue;
      ++solved;
      EXPECT_TRUE(robot.within_limits(result.q));
      EXPECT_LE(result.position_error, 1e-6);
      EXPECT_LE(result.rotation_error, 1e-6);
      expect_reached(task, target, judge.fk(result.q), name);
    }
    EXPECT_EQ(solved, cases) << name << ", seed " << iksel_test::seed();
  }
}

INSTANTIATE_TEST_SUITE_P(All, TasksOfRobots, testing::ValuesIn(iksel_test::all_robots()),
                         iksel_test::name_of);

TEST(FewerThanSixJoints, ReachFullPoses) {
  for (const char* name : {"xarm5", "wx250"}) {
    const Robot& robot = iksel_test::robot(name);
    iksel_test::Judge judge(robot);
    const Solver& solver = iksel_test::solver(name);
    const int cases = iksel_test::cases(2000);
    const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
    int solved = 0;
    for (int i = 0; i < cases; ++i) {
      const Pose target = judge.fk(q.row(i));
      const Result result = solver.solve(target);
      if (!result.success()) continue;
      ++solved;
      judge.expect_solution(target, result.q);
    }
    EXPECT_EQ(solved, cases) << name << ", seed " << iksel_test::seed();
  }
}

TEST(FewerThanSixJoints, APlanarArmReachesAPlanarTask) {
  const char* urdf = R"(<robot name="planar"><link name="base"/><link name="a"/><link name="b"/>
    <link name="tip"/>
    <joint name="q1" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
      <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
    <joint name="q2" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.4 0 0.1"/>
      <axis xyz="0 0 1"/><limit lower="-2.5" upper="2.5" effort="1" velocity="1"/></joint>
    <joint name="q3" type="revolute"><parent link="b"/><child link="tip"/><origin xyz="0.3 0 0"/>
      <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)";
  iksel::RobotOptions links;
  links.tcp.translation().x() = 0.2;
  const Robot robot = Robot::from_urdf_string(urdf, links);
  SolverOptions options;
  options.task = Task::planar();
  const Solver solver(robot, options);
  const int cases = iksel_test::cases(1000);
  const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
  for (int i = 0; i < cases; ++i) {
    // Lifted off the plane and tilted, which a planar task does not look at.
    Pose target = robot.fk(q.row(i));
    const double yaw = q.row(i).sum();
    target.translation().z() += 0.3;
    target.linear() = target.linear() * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX());
    const Result result = solver.solve(target);
    ASSERT_TRUE(result.success()) << "case " << i << ", seed " << iksel_test::seed();
    EXPECT_LT(
        (robot.fk(result.q) * Eigen::Vector3d::Zero() - target.translation()).head<2>().norm(),
        1e-6);
    EXPECT_LT(std::abs(std::remainder(result.q.sum() - yaw, 2 * kPi)), 1e-6);
  }
}

TEST(Boxes, AreUsedAndNotOnlyAccepted) {
  // A target a little farther away than the arm can reach, stretched out: only its box is in reach.
  const Robot& robot = iksel_test::robot("xarm5");
  iksel_test::Judge judge(robot);
  SolverOptions options;
  options.task = Task::box({0.02, 0.02, 0.02}, {0.2, 0.2, 0.2});
  const Solver with_box(robot, options);
  const Solver without(robot, SolverOptions{}, with_box.database());
  Random random(iksel_test::seed());
  const int cases = iksel_test::cases(200);
  const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
  int exact = 0;
  for (int i = 0; i < cases; ++i) {
    // Five joints cannot follow a target that is moved in six.
    Vector6 d;
    for (int k = 0; k < 6; ++k) d[k] = random.uniform(-1, 1) * (k < 3 ? 0.015 : 0.1);
    const Pose target = TaskSpace(Task::pose(), 0, 0).pose_at(robot.fk(q.row(i)), d);
    if (without.solve(target).success()) ++exact;
    const Result result = with_box.solve(target);
    ASSERT_TRUE(result.success()) << "case " << i << ", seed " << iksel_test::seed();
    expect_reached(options.task, target, judge.fk(result.q), "box");
  }
  EXPECT_EQ(exact, 0);
}

TEST(Tasks, SolveWithEverySchemeAndByKdl) {
  const Robot& robot = iksel_test::robot("irb14050");
  const iksel::Database database = iksel::Database::build(robot);
  const int cases = iksel_test::cases(100);
  const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
  for (const auto iteration :
       {iksel::Iteration::lm, iksel::Iteration::dls, iksel::Iteration::pinv,
        iksel::Iteration::pinv_rr, iksel::Iteration::cwln, iksel::Iteration::cwpi}) {
    for (const auto kinematics : {iksel::Kinematics::kernel, iksel::Kinematics::kdl}) {
      SolverOptions options;
      iksel::Paper& paper = iksel_test::paper_of(options);
      paper.iteration = iteration;
      paper.kinematics = kinematics;
      paper.candidates = 100;
      paper.whole_turns = true;
      options.task = Task::free_spin();
      const Solver solver(robot, options, database);
      int solved = 0;
      for (int i = 0; i < cases; ++i) {
        const Pose target = robot.fk(q.row(i));
        const Result result = solver.solve(target);
        if (!result.success()) continue;
        ++solved;
        expect_reached(options.task, target, robot.fk(result.q), "free spin");
      }
      EXPECT_GE(solved, cases * 99 / 100) << static_cast<int>(iteration);
    }
  }
}

TEST(Tasks, TakeSeedsAndGiveTheSameBitsInBatches) {
  const Robot& robot = iksel_test::robot("panda");
  SolverOptions options;
  options.task = Task::position_only();
  const Solver solver(robot, options);
  const int cases = iksel_test::cases(200);
  const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
  std::vector<Pose> targets;
  for (int i = 0; i < cases; ++i) targets.push_back(robot.fk(q.row(i)));
  const std::vector<Result> one = solver.solve_batch(targets, {}, {}, 1);
  const std::vector<Result> batch = solver.solve_batch(targets, {}, {}, 3);
  for (int i = 0; i < cases; ++i) {
    ASSERT_TRUE(one[static_cast<std::size_t>(i)].success());
    EXPECT_EQ(one[static_cast<std::size_t>(i)].q, batch[static_cast<std::size_t>(i)].q);
    const Result seeded =
        iksel_test::solve_from(solver, targets[static_cast<std::size_t>(i)], q.row(i));
    ASSERT_TRUE(seeded.success());
    EXPECT_EQ(seeded.attempts, 1);
    EXPECT_LT((seeded.q - q.row(i).transpose()).norm(), 1e-9);
  }
}

TEST(Tasks, OfACallTakeThePlaceOfTheOptions) {
  const Robot& robot = iksel_test::robot("cvr038");
  const Solver& solver = iksel_test::solver("cvr038");
  const int cases = iksel_test::cases(100);
  const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
  for (const auto& [name, task] : tasks()) {
    iksel::SolveRequest request;
    request.task = task;
    iksel::SolveRequest picky = request;
    picky.filter =
        iksel::filter_each(robot.dof(), [](const JointVector& at) { return at[1] < 0.5; });
    iksel::SolveRequest seeded = request;
    seeded.database_seeds = false;
    for (int i = 0; i < cases; ++i) {
      const Pose target = robot.fk(q.row(i));
      const Result result = solver.solve(target, request);
      ASSERT_TRUE(result.success()) << name << ", case " << i << ", seed " << iksel_test::seed();
      expect_reached(task, target, robot.fk(result.q), name);
      seeded.seeds = {q.row(i)};
      EXPECT_TRUE(solver.solve(target, seeded).success()) << name;
      // One passes: the target is made of it. Where none does, all seeds are tried, which takes
      // long.
      if (q(i, 1) >= 0.5 || task.constrained_axes() == 6) continue;
      const Result filtered = solver.solve(target, picky);
      ASSERT_TRUE(filtered.success()) << name << ", case " << i << ", seed " << iksel_test::seed();
      EXPECT_LT(filtered.q[1], 0.5);
      expect_reached(task, target, robot.fk(filtered.q), name);
    }
  }
}

TEST(Tasks, TheNearestSolutionUsesWhatTheyLeaveOpen) {
  // No small move within the task makes the answer a nearer one: random moves, brought back to the
  // task by solving from them, are the oracle.
  Random random(iksel_test::seed());
  int farther = 0;
  int total = 0;
  for (const char* name : {"ur3", "panda", "xarm5"}) {
    const Robot& robot = iksel_test::robot(name);
    const Solver& solver = iksel_test::solver(name);
    for (const auto& [task_name, task] : tasks()) {
      for (int i = 0; i < iksel_test::cases(200, 20) / 10; ++i) {
        const Eigen::MatrixXd q = robot.random_configurations(1, random.next());
        const Pose target = robot.fk(q.row(0));
        iksel::SolveRequest request;
        request.task = task;
        JointVector near = q.row(0);
        for (int j = 0; j < robot.dof(); ++j) near[j] += random.uniform(-0.3, 0.3);
        request.near = near;
        const Result nearest = solver.solve(target, request);
        ASSERT_TRUE(nearest.success()) << name << ", " << task_name;
        expect_reached(task, target, robot.fk(nearest.q), task_name);
        EXPECT_NEAR(nearest.move, (nearest.q - near).norm(), 1e-12);
        ++total;
        farther += nearest.move > (q.row(0).transpose() - near).norm() + 1e-4;
        iksel::SolveRequest from;
        from.task = task;
        from.database_seeds = false;
        // Answers of an isolated solution lie so far apart where the arm is all but singular.
        const bool is_isolated = robot.dof() <= iksel::TaskSpace(task, 0, 0).fixed_axes();
        const double slack = is_isolated ? 2e-3 : 1e-4;
        for (int k = 0; k < 20; ++k) {
          JointVector moved = nearest.q;
          for (int j = 0; j < robot.dof(); ++j) moved[j] += random.uniform(-0.02, 0.02);
          from.seeds = {moved};
          const Result other = solver.solve(target, from);
          if (!other.success() || (other.q - nearest.q).norm() > 0.2) continue;
          EXPECT_GE((other.q - near).norm(), nearest.move - slack)
              << name << ", " << task_name << ", seed " << iksel_test::seed();
        }
      }
    }
  }
  // A local minimum is not the least: in 15,000 such cases 16 lie farther.
  EXPECT_LE(farther, 1 + total / 100) << "seed " << iksel_test::seed();
}

TEST(Tasks, SayWhenThePositionIsOutOfReach) {
  const Robot& robot = iksel_test::robot("ur3");
  Pose target = robot.fk(robot.random_configurations(1, 1).row(0));
  target.translation() = robot.reach_centre() + Eigen::Vector3d(robot.reach() + 0.05, 0, 0);
  SolverOptions options;
  options.task = Task::position_only();
  const Solver solver(robot, options);
  EXPECT_EQ(solver.solve(target).status, Status::out_of_reach);
  options.task.position_lower[0] = -0.6;  // along the tool's x, wherever that points
  options.task.position_lower[1] = -0.6;
  options.task.position_lower[2] = -0.6;
  options.task.position_upper = {0.6, 0.6, 0.6};
  const Solver roomy(robot, options, solver.database());
  EXPECT_EQ(roomy.solve(target).status, Status::solved);
}

TEST(Tasks, RefuseBoundsThatMakeNoSense) {
  const auto refused = [](const Task& task) {
    SolverOptions options;
    options.task = task;
    try {
      options.validate();
    } catch (const iksel::InvalidArgumentError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Task task;
  EXPECT_EQ(refused(task), "");
  task.position_lower[1] = 0.1;
  EXPECT_NE(refused(task).find("position y"), std::string::npos);
  task = Task{};
  task.position_upper[2] = std::nan("");
  EXPECT_NE(refused(task).find("position z"), std::string::npos);
  task = Task{};
  task.rotation_upper[0] = 4;
  EXPECT_NE(refused(task).find("rotation x"), std::string::npos);
  task.rotation_upper[0] = kInfinity;  // half free
  EXPECT_NE(refused(task).find("rotation x"), std::string::npos);
  task = Task::position_only();
  for (std::size_t i = 0; i < 3; ++i) {
    task.position_lower[i] = -kInfinity;
    task.position_upper[i] = kInfinity;
  }
  EXPECT_NE(refused(task).find("nothing to reach"), std::string::npos);
  EXPECT_THROW(static_cast<void>(Task::box({-1, 0, 0}, {0, 0, 0})), iksel::InvalidArgumentError);
}

TEST(Tasks, CountTheAxesTheyConstrain) {
  EXPECT_EQ(Task::pose().constrained_axes(), 6);
  EXPECT_EQ(Task::position_only().constrained_axes(), 3);
  EXPECT_EQ(Task::free_spin().constrained_axes(), 5);
  EXPECT_EQ(Task::planar().constrained_axes(), 3);
  EXPECT_EQ(Task::box({0, 0, kInfinity}, {0, 0, kPi}).constrained_axes(), 4);
}

}  // namespace
