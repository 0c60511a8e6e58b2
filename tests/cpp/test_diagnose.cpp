// SPDX-License-Identifier: BSD-3-Clause
// Each reason of a failure, produced on purpose.
#include <gtest/gtest.h>

#include <algorithm>
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
      iksel::SolveRequest proving;
      proving.prove = true;
      const iksel::Result result = solver.solve(target, proving);
      const Diagnosis diagnosis = solver.diagnose(target);
      EXPECT_EQ(diagnosis.cause == Cause::none, result.success()) << name << ", case " << i;
      EXPECT_EQ(diagnosis.proof, result.proof) << name << ", case " << i;
      EXPECT_EQ(diagnosis.q_is_solution,
                diagnosis.position_error <= 1e-6 && diagnosis.rotation_error <= 1e-6)
          << name << ", case " << i << ": " << diagnosis.message;
      expect_honest(robot, target, diagnosis);
    }
  }
}

/// By how much q lies outside of the limits at the whole turns nearest to them.
double violation(const Robot& robot, JointVector q) {
  const JointVector middle = (robot.lower() + robot.upper()) / 2;
  for (int j = 0; j < robot.dof(); ++j)
    q[j] = middle[j] + std::remainder(q[j] - middle[j], 2 * M_PI);
  return (robot.lower() - q).cwiseMax(q - robot.upper()).maxCoeff();
}

TEST(Diagnose, ExplainsAProvenNoByItsBranchesWithoutASearch) {
  int outside = 0;
  int none = 0;
  for (const char* name : {"ur3", "irb120", "vs060"}) {
    const Robot& robot = iksel_test::robot(name);
    const Solver& solver = iksel_test::solver(name);
    const Solver unlimited(robot.without_limits());
    const int cases = iksel_test::cases(200, 40);
    const Eigen::MatrixXd q = robot.random_configurations(2 * cases, iksel_test::seed());
    for (int i = 0; i < cases; ++i) {
      Pose target = robot.fk(q.row(2 * i));
      target.linear() = robot.fk(q.row(2 * i + 1)).linear();
      if (solver.solve(target).proof != iksel::Proof::closed_form) continue;
      const Diagnosis diagnosis = solver.diagnose(target);
      SCOPED_TRACE(std::string(name) + ", case " + std::to_string(i) + ": " + diagnosis.message);
      EXPECT_EQ(diagnosis.proof, iksel::Proof::closed_form);
      EXPECT_EQ(diagnosis.attempts, 0);
      expect_honest(robot, target, diagnosis);
      double least = 10;
      for (const auto& branch : unlimited.solve_all(target).all) {
        least = std::min(least, violation(robot, branch.q));
      }
      if (diagnosis.cause == Cause::joint_limits) {
        ++outside;
        const auto e = iksel::pose_error(target, robot.fk(diagnosis.branch));
        EXPECT_LT(e.norm(), 1e-9);
        EXPECT_NEAR(diagnosis.limit_violation, least, 1e-5);
        EXPECT_DOUBLE_EQ(diagnosis.limit_violation, violation(robot, diagnosis.branch));
        const double at = diagnosis.branch[diagnosis.joint];
        EXPECT_DOUBLE_EQ(diagnosis.limit_violation, std::max(robot.lower()[diagnosis.joint] - at,
                                                             at - robot.upper()[diagnosis.joint]));
      } else {
        ++none;
        ASSERT_EQ(diagnosis.cause, Cause::no_branch);
        EXPECT_EQ(least, 10) << "a branch by search";
        EXPECT_EQ(diagnosis.branch.size(), 0);
        EXPECT_FALSE(diagnosis.beyond_reach <= 0);
      }
      const auto joint = static_cast<std::size_t>(diagnosis.joint);
      EXPECT_NE(diagnosis.message.find("'" + robot.joint_names()[joint] + "'"), std::string::npos);
    }
  }
  EXPECT_GT(outside, 0);
  EXPECT_GT(none, 0);
}

TEST(Diagnose, ExplainsATasksNoByTheTasksBranches) {
  // The spin is the last joint's, which no limit of its own can keep from an answer.
  int outside = 0;
  int none = 0;
  for (const char* name : {"ur5e", "irb120"}) {
    const Robot& robot = iksel_test::robot(name);
    constexpr int kSpinning = 5;
    SolverOptions options;
    options.task = iksel::Task::free_spin();
    const Solver solver(robot, options);
    const Solver unlimited(robot.without_limits(), options);
    const int cases = iksel_test::cases(400, 80);
    const Eigen::MatrixXd q = robot.random_configurations(2 * cases, iksel_test::seed());
    for (int i = 0; i < cases; ++i) {
      Pose target = robot.fk(q.row(2 * i));
      target.linear() = robot.fk(q.row(2 * i + 1)).linear();
      if (solver.solve(target).proof != iksel::Proof::closed_form) continue;
      const Diagnosis diagnosis = solver.diagnose(target);
      SCOPED_TRACE(std::string(name) + ", case " + std::to_string(i) + ": " + diagnosis.message);
      EXPECT_TRUE(robot.within_limits(diagnosis.q));
      EXPECT_NE(diagnosis.joint, kSpinning);
      double least = 10;
      for (const auto& branch : unlimited.solve_all(target).all) {
        JointVector felt = branch.q;
        felt[kSpinning] = 0.5 * (robot.lower() + robot.upper())[kSpinning];
        least = std::min(least, violation(robot, felt));
      }
      EXPECT_EQ(diagnosis.attempts, 0);
      if (diagnosis.cause != Cause::joint_limits) {
        ++none;
        EXPECT_EQ(diagnosis.cause, Cause::no_branch);
        EXPECT_EQ(least, 10) << "a branch by search";
        continue;
      }
      ++outside;
      EXPECT_NEAR(diagnosis.limit_violation, least, 1e-5);
      EXPECT_DOUBLE_EQ(diagnosis.limit_violation, violation(robot, diagnosis.branch));
    }
  }
  EXPECT_GT(outside, 0);
  EXPECT_GT(none, 0);
}

/// From the axis of joint 2 to where a link is, across that axis.
Eigen::Vector3d across_axis_2(const Robot& robot, const JointVector& q, const std::string& from,
                              const std::string& to) {
  const auto& names = robot.link_names();
  const std::vector<Pose> links = robot.link_poses(q);
  const auto place = [&](const std::string& name) {
    const auto i = std::find(names.begin(), names.end(), name) - names.begin();
    return links.at(static_cast<std::size_t>(i)).translation();
  };
  JointVector turned = q;
  turned[1] += 0.1;
  const Eigen::Vector3d axis =
      iksel::pose_error(robot.fk(turned), robot.fk(q)).tail<3>().normalized();
  const Eigen::Vector3d way = place(to) - place(from);
  return way - axis * axis.dot(way);
}

TEST(Diagnose, SaysByHowMuchAnElbowIsTooShort) {
  // Stretched out as far as joint 3 lets it, and the target moved on by what is then missing.
  constexpr double kMissing = 0.02;
  const std::string ends[][3] = {{"ur3", "upper_arm_link", "wrist_1_link"},
                                 {"irb120", "link_2", "link_5"}};
  for (const auto& [name, from, to] : ends) {
    const Robot& robot = iksel_test::robot(name);
    const Solver& solver = iksel_test::solver(name);
    const Eigen::MatrixXd q = robot.random_configurations(40, iksel_test::seed());
    int same = 0;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      JointVector at = q.row(i);
      double low = -M_PI;
      double high = M_PI;
      const auto length = [&](double elbow) {
        at[2] = elbow;
        return across_axis_2(robot, at, from, to).norm();
      };
      // Of angles all around, the best, and then between its neighbours.
      double best = low;
      for (double elbow = low; elbow < high; elbow += 0.1) {
        if (length(elbow) > length(best)) best = elbow;
      }
      low = best - 0.1;
      high = best + 0.1;
      while (high - low > 1e-7) {
        const double third = (high - low) / 3;
        if (length(low + third) < length(high - third)) {
          low += third;
        } else {
          high -= third;
        }
      }
      length(low);
      Pose target = robot.fk(at);
      target.translation() += kMissing * across_axis_2(robot, at, from, to).normalized();
      const Diagnosis diagnosis = solver.diagnose(target);
      if (diagnosis.cause != Cause::no_branch || diagnosis.joint != 2) continue;
      // Another branch may come nearer.
      EXPECT_LE(diagnosis.beyond_reach, kMissing + 1e-9) << name << ": " << diagnosis.message;
      EXPECT_GT(diagnosis.beyond_reach, 0);
      same += std::abs(diagnosis.beyond_reach - kMissing) < 1e-9;
    }
    EXPECT_GT(same, 5) << name;
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
