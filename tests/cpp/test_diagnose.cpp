// SPDX-License-Identifier: BSD-3-Clause
// Each reason of a failure, produced on purpose.
#include <gtest/gtest.h>

#include <cmath>

#include "iksel/iksel.hpp"
#include "robots.hpp"

namespace {

using iksel::Cause;
using iksel::Diagnosis;
using iksel::JointVector;
using iksel::Pose;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;
using iksel::SolverOptions;

/// Three parallel axes, links of 0.4, 0.3 and 0.2 m, joints within -limit .. limit.
Robot planar_arm(const std::string& limit) {
  const std::string range = "<limit lower=\"-" + limit + "\" upper=\"" + limit +
                            "\" effort=\"1\" velocity=\"1\"/><axis xyz=\"0 0 1\"/></joint>";
  iksel::RobotOptions links;
  links.tcp.translation().x() = 0.2;
  return Robot::from_urdf_string(
      R"(<robot name="planar"><link name="base"/><link name="a"/><link name="b"/><link name="tip"/>
      <joint name="q1" type="revolute"><parent link="base"/><child link="a"/>)" +
          range + R"(<joint name="q2" type="revolute"><parent link="a"/><child link="b"/>
      <origin xyz="0.4 0 0"/>)" +
          range + R"(<joint name="q3" type="revolute"><parent link="b"/><child link="tip"/>
      <origin xyz="0.3 0 0"/>)" +
          range + "</robot>",
      links);
}

/// What every diagnosis promises of its q.
void expect_honest(const Robot& robot, const Pose& target, const Diagnosis& diagnosis) {
  ASSERT_EQ(diagnosis.q.size(), robot.dof());
  EXPECT_TRUE(robot.within_limits(diagnosis.q));
  const auto e = iksel::pose_error(target, robot.fk(diagnosis.q));
  EXPECT_NEAR(diagnosis.position_error, e.head<3>().norm(), 1e-9);
  EXPECT_NEAR(diagnosis.rotation_error, e.tail<3>().norm(), 1e-9);
  EXPECT_FALSE(diagnosis.message.empty());
}

TEST(Diagnose, SaysNoneWhereThereIsAnAnswer) {
  const Robot& robot = iksel_test::robot("ur3");
  const Solver& solver = iksel_test::solver("ur3");
  const Pose target = robot.fk(JointVector::Constant(6, 0.5));
  const Diagnosis diagnosis = solver.diagnose(target);
  EXPECT_EQ(diagnosis.cause, Cause::none);
  EXPECT_TRUE(diagnosis.q_is_solution);
  expect_honest(robot, target, diagnosis);
}

TEST(Diagnose, SaysHowFarBeyondReachAPositionLies) {
  const Robot robot = planar_arm("3");
  SolverOptions options;
  options.task = iksel::Task::position_only();
  const Solver solver(robot, options);
  // Both beyond what the links add up to, and off the plane within it.
  Pose target = Pose::Identity();
  target.translation() << 0.9 + 0.25, 0, 0;
  Diagnosis diagnosis = solver.diagnose(target);
  EXPECT_EQ(diagnosis.cause, Cause::out_of_reach) << diagnosis.message;
  EXPECT_NEAR(diagnosis.beyond_reach, 0.25, 1e-6);
  EXPECT_NEAR(diagnosis.position_error, 0.25, 1e-6);
  EXPECT_FALSE(diagnosis.q_is_solution);
  target.translation() << 0.3, 0.4, 0.07;
  diagnosis = solver.diagnose(target);
  EXPECT_EQ(diagnosis.cause, Cause::out_of_reach) << diagnosis.message;
  EXPECT_NEAR(diagnosis.beyond_reach, 0.07, 1e-6);
  EXPECT_TRUE(std::isnan(diagnosis.rotation_gap));
}

TEST(Diagnose, SaysByHowMuchARotationIsMissed) {
  // The plane's normal cannot be tilted: the angle of the tilt is what is missing.
  const Robot robot = planar_arm("3");
  const Solver solver(robot);
  for (const double tilt : {0.2, 0.7}) {
    Pose target = robot.fk((JointVector(3) << 0.4, 0.8, -0.5).finished());
    target.linear() = target.linear() * Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX());
    const Diagnosis diagnosis = solver.diagnose(target);
    EXPECT_EQ(diagnosis.cause, Cause::orientation) << diagnosis.message;
    EXPECT_NEAR(diagnosis.rotation_gap, tilt, 1e-3);
    EXPECT_LE(diagnosis.position_error, 1e-6);
    EXPECT_FALSE(diagnosis.q_is_solution);
    expect_honest(robot, target, diagnosis);
  }
}

TEST(Diagnose, NamesTheJointThatWouldHaveToLeaveItsLimitsAndByHowMuch) {
  const Robot robot = planar_arm("1");
  const Solver solver(robot);
  // With both branches known: elbow q2 = +-1.3, of which the one below asks more of q1 or q3.
  const Robot wide = planar_arm("3");
  const Pose target = wide.fk((JointVector(3) << 0.2, 1.3, -0.1).finished());
  const iksel::Solutions branches = Solver(wide).solve_all(target);
  ASSERT_EQ(branches.all.size(), 2U);
  double least = 10;
  for (const auto& branch : branches.all) {
    least = std::min(least, branch.q.cwiseAbs().maxCoeff() - 1);
  }
  const Diagnosis diagnosis = solver.diagnose(target);
  EXPECT_EQ(diagnosis.cause, Cause::joint_limits) << diagnosis.message;
  EXPECT_NEAR(least, 0.3, 1e-6);
  EXPECT_EQ(diagnosis.joint, 1);
  EXPECT_NEAR(diagnosis.limit_violation, least, 1e-5);
  EXPECT_NE(diagnosis.message.find("'q2'"), std::string::npos) << diagnosis.message;
  EXPECT_FALSE(diagnosis.q_is_solution);
  expect_honest(robot, target, diagnosis);
}

TEST(Diagnose, CountsWhatAFilterRefuses) {
  const Robot& robot = iksel_test::robot("ur3");
  const Solver& solver = iksel_test::solver("ur3");
  const Pose target = robot.fk((JointVector(6) << 0.3, -1.1, 1.2, 0.4, 0.9, 0.2).finished());
  SolveRequest request;
  request.filter = iksel::filter_each(6, [](const JointVector&) { return false; });
  const Diagnosis diagnosis = solver.diagnose(target, request);
  EXPECT_EQ(diagnosis.cause, Cause::rejected) << diagnosis.message;
  EXPECT_EQ(diagnosis.refused, static_cast<int>(solver.solve_all(target).all.size()));
  EXPECT_FALSE(diagnosis.q_is_solution);
  expect_honest(robot, target, diagnosis);
}

TEST(Diagnose, SaysWhenTheBoundsOnWorkAreTooLow) {
  const Robot& robot = iksel_test::robot("cvr038");
  SolverOptions options;
  options.max_attempts = 1;
  options.max_iterations = 1;
  const Solver solver(robot, options);
  const Pose target = robot.fk(robot.random_configurations(1, 1).row(0));
  ASSERT_FALSE(solver.solve(target).success());
  const Diagnosis diagnosis = solver.diagnose(target);
  EXPECT_EQ(diagnosis.cause, Cause::budget) << diagnosis.message;
  EXPECT_TRUE(diagnosis.q_is_solution);
  EXPECT_LE(diagnosis.position_error, options.position_tolerance);
}

TEST(Diagnose, SaysWhenTheOnlyAnswersAreSingular) {
  // Stretched out: the tip is as far as it goes, where the Jacobian has lost a rank.
  const Robot robot = planar_arm("3");
  SolverOptions options;
  options.task = iksel::Task::position_only();
  options.max_attempts = 1;
  options.max_iterations = 2;
  const Solver solver(robot, options);
  Pose target = Pose::Identity();
  target.translation() << 0.9 * std::cos(0.6), 0.9 * std::sin(0.6), 0;
  ASSERT_FALSE(solver.solve(target).success());
  const Diagnosis diagnosis = solver.diagnose(target);
  EXPECT_EQ(diagnosis.cause, Cause::singular) << diagnosis.message;
  EXPECT_TRUE(diagnosis.q_is_solution);
  EXPECT_LT(diagnosis.least_singular_value, 1e-2);
}

TEST(Diagnose, SaysWhenADeadlinePassed) {
  const Robot& robot = iksel_test::robot("panda");
  const Solver& solver = iksel_test::solver("panda");
  const Pose target = robot.fk(robot.random_configurations(1, 3).row(0));
  SolveRequest request;
  request.deadline = 1e-9;
  // What the first seeds find counts even then: only a filter keeps the search going.
  int asked = 0;
  request.filter = iksel::filter_each(7, [&](const JointVector&) { return ++asked > 100; });
  ASSERT_EQ(solver.solve(target, request).status, iksel::Status::out_of_time);
  asked = 0;
  const Diagnosis diagnosis = solver.diagnose(target, request);
  EXPECT_EQ(diagnosis.cause, Cause::out_of_time) << diagnosis.message;
  EXPECT_TRUE(diagnosis.q_is_solution);
}

TEST(Diagnose, FindsAReasonForWhateverFails) {
  // Any pose in the ball around the arm: most cannot be reached.
  for (const char* name : {"ur3", "panda", "cvr038", "xarm5"}) {
    const Robot& robot = iksel_test::robot(name);
    const Solver& solver = iksel_test::solver(name);
    const int cases = iksel_test::cases(200, 40) / 20;
    const Eigen::MatrixXd q = robot.random_configurations(2 * cases, iksel_test::seed());
    for (int i = 0; i < cases; ++i) {
      Pose target = robot.fk(q.row(2 * i));
      target.linear() = robot.fk(q.row(2 * i + 1)).linear();
      target.translation() *= 1 + 0.5 * std::sin(i);
      const bool solved = solver.solve(target).success();
      const Diagnosis diagnosis = solver.diagnose(target);
      EXPECT_EQ(diagnosis.cause == Cause::none, solved) << name << ", case " << i;
      EXPECT_EQ(diagnosis.q_is_solution,
                diagnosis.position_error <= 1e-6 && diagnosis.rotation_error <= 1e-6)
          << name << ", case " << i << ": " << diagnosis.message;
      expect_honest(robot, target, diagnosis);
    }
  }
}

TEST(DqDx, IsTheDerivativeOfAnswersSolvedAgain) {
  for (const char* name : {"ur3", "cvr038", "irb14050"}) {
    const Robot& robot = iksel_test::robot(name);
    SolverOptions options;
    options.position_tolerance = options.rotation_tolerance = 1e-11;
    const Solver solver(robot, options);
    const int cases = iksel_test::cases(200, 40) / 4;
    const Eigen::MatrixXd q = robot.random_configurations(cases, iksel_test::seed());
    int compared = 0;
    for (int i = 0; i < cases; ++i) {
      const JointVector at = q.row(i);
      const Pose pose = robot.fk(at);
      const iksel::Matrix derivative = robot.inverse_jacobian(at);
      ASSERT_EQ(derivative.rows(), robot.dof());
      // Steps much smaller than the distance from a singularity and from the limits.
      if (derivative.norm() > 30) continue;
      constexpr double kStep = 1e-5;
      const bool inside = ((at - robot.lower()).array() > 1e-2).all() &&
                          ((robot.upper() - at).array() > 1e-2).all();
      if (!inside) continue;
      for (int k = 0; k < 6; ++k) {
        JointVector ends[2];
        bool solved = true;
        for (int side = 0; side < 2; ++side) {
          Pose moved = pose;
          const double step = side == 0 ? kStep : -kStep;
          if (k < 3) {
            moved.translation()[k] += step;
          } else {
            moved.linear() = Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(k - 3)) * pose.linear();
          }
          const iksel::Result result = iksel_test::solve_from(solver, moved, at);
          solved = solved && result.success();
          ends[side] = result.q;
        }
        ASSERT_TRUE(solved) << name << ", case " << i << ", seed " << iksel_test::seed();
        const JointVector difference = (ends[0] - ends[1]) / (2 * kStep);
        if ((ends[0] - at).norm() > 1e-2) continue;  // another branch
        ++compared;
        // A redundant arm may move along its self-motion besides: the part along J^T counts.
        const JointVector column = derivative.col(k);
        const Eigen::MatrixXd J = robot.jacobian(at);
        const double error =
            robot.dof() == 6 ? (difference - column).norm() : (J * (difference - column)).norm();
        EXPECT_LT(error, 1e-3 * (1 + column.norm()))
            << name << ", case " << i << ", direction " << k << ", seed " << iksel_test::seed();
      }
    }
    EXPECT_GT(compared, cases) << name;
  }
}

TEST(DqDx, IsBoundedByItsDamping) {
  const Robot& robot = iksel_test::robot("panda");
  const Eigen::MatrixXd q = robot.random_configurations(50, 2);
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Eigen::MatrixXd J = robot.jacobian(q.row(i));
    constexpr double kDamping = 0.05;
    const Eigen::MatrixXd damped = robot.inverse_jacobian(q.row(i), kDamping);
    // Another form of the same: (J^T J + d^2 I)^-1 J^T.
    const Eigen::MatrixXd A =
        J.transpose() * J + kDamping * kDamping * Eigen::MatrixXd::Identity(7, 7);
    EXPECT_LT((damped - A.inverse() * J.transpose()).norm(), 1e-9);
    // The largest of s / (s^2 + d^2) is 1 / (2 d).
    EXPECT_LE(damped.norm(), std::sqrt(6.0) / (2 * kDamping) + 1e-9);
    EXPECT_LT((J * robot.inverse_jacobian(q.row(i)) - Eigen::MatrixXd::Identity(6, 6)).norm(),
              1e-6);
  }
  EXPECT_THROW(static_cast<void>(robot.inverse_jacobian(q.row(0), -1)),
               iksel::InvalidArgumentError);
}

}  // namespace
