// SPDX-License-Identifier: BSD-3-Clause
// Laws of solving: FK(IK(T)) = T, inside the limits, bounded work, an honest status.
#include <gtest/gtest.h>

#include <cmath>
#include <iksel/iksel.hpp>
#include <limits>

#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolverOptions;
using iksel::Status;

class SolverOfRobots : public testing::TestWithParam<std::string> {};

TEST_P(SolverOfRobots, AnswersAreSolutions) {
  const Robot& robot = iksel_test::robot(GetParam());
  iksel_test::Judge judge(robot);
  const Solver& solver = iksel_test::solver(GetParam());
  const int n = iksel_test::cases(300);
  const Eigen::MatrixXd q =
      robot.random_configurations(static_cast<std::size_t>(n), iksel_test::seed());
  int solved = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Pose target = judge.fk(q.row(i));
    const Result result = solver.solve(target);
    if (!result.success()) {
      EXPECT_EQ(result.q.size(), 0);
      EXPECT_TRUE(std::isnan(result.position_error));
      continue;
    }
    ++solved;
    judge.expect_solution(target, result.q);
    const auto e = iksel::pose_error(target, judge.fk(result.q));
    EXPECT_NEAR(e.head<3>().norm(), result.position_error, 1e-13);
    EXPECT_NEAR(e.tail<3>().norm(), result.rotation_error, 1e-13);
    EXPECT_GE(result.attempts, 1);
  }
  EXPECT_GE(solved, robot.dof() < 6 ? n * 6 / 10 : n * 99 / 100) << "seed " << iksel_test::seed();
}

TEST_P(SolverOfRobots, WorkIsBounded) {
  const Robot& robot = iksel_test::robot(GetParam());
  SolverOptions options = SolverOptions::paper();
  options.database.scale = iksel::Scale::small;
  options.max_attempts = 5;
  const Solver solver(robot, options);
  const Eigen::MatrixXd q = robot.random_configurations(100, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    // The position of one pose with the rotation of another: mostly unreachable.
    Pose target = robot.fk(q.row(i));
    target.linear() = robot.fk(q.row((i + 1) % q.rows())).linear();
    const Result result = solver.solve(target);
    EXPECT_LE(result.attempts, 5);
    EXPECT_LE(result.iterations, 5 * options.max_iterations);
  }
}

TEST_P(SolverOfRobots, SolutionAsSeedIsTheAnswer) {
  const Robot& robot = iksel_test::robot(GetParam());
  const Solver& solver = iksel_test::solver(GetParam());
  const Eigen::MatrixXd q = robot.random_configurations(50, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const JointVector seed = q.row(i);
    const Result result = iksel_test::solve_from(solver, robot.fk(seed), seed);
    ASSERT_TRUE(result.success());
    EXPECT_EQ(result.attempts, 1);
    EXPECT_LE(result.iterations, 1);
    EXPECT_LT((result.q - seed).norm(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, SolverOfRobots, testing::ValuesIn(iksel_test::all_robots()),
                         iksel_test::name_of);

const Robot& ur3() { return iksel_test::robot("ur3_wrs"); }

TEST(Solver, TriesTheSeedFirstAndThenTheDatabase) {
  const Robot& robot = ur3();
  const Solver& solver = iksel_test::solver("ur3_wrs");
  const Eigen::MatrixXd q = robot.random_configurations(100, iksel_test::seed());
  int solved = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    // A singular seed far away leads nowhere by itself; it may even lie outside the limits.
    const JointVector seed = JointVector::Constant(6, i % 2 == 0 ? 0.0 : 7.0);
    solved += iksel_test::solve_from(solver, robot.fk(q.row(i)), seed).success();
  }
  EXPECT_GE(solved, 99);
}

TEST(Solver, SaysWhatIsOutOfReach) {
  const Robot& robot = ur3();
  const Solver& solver = iksel_test::solver("ur3_wrs");
  Pose target = Pose::Identity();
  target.translation() = robot.reach_centre() + Eigen::Vector3d(0, 0, robot.reach() * 1.01);
  const Result result = solver.solve(target);
  EXPECT_EQ(result.status, Status::out_of_reach);
  EXPECT_EQ(result.attempts, 0);
}

TEST(Solver, SaysWhenOnlyTheLimitsAreInTheWay) {
  // One joint that could reach the target only half a turn beyond its limits.
  const char* xml =
      "<robot name='one'><link name='a'/><link name='b'/><joint name='j' type='revolute'>"
      "<parent link='a'/><child link='b'/><origin xyz='0 0 0'/><axis xyz='0 0 1'/>"
      "<limit lower='-1' upper='1' effort='0' velocity='1'/></joint></robot>";
  const Robot robot = Robot::from_urdf_string(xml);
  SolverOptions options = SolverOptions::paper();
  options.database.sampling = iksel::Sampling::random;
  options.database.samples = 50;
  options.max_iterations = 20;
  const Solver solver(robot, options);
  Pose target = Pose::Identity();
  target.rotate(Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(solver.solve(target).status, Status::outside_limits);
  target = Pose::Identity();
  target.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(solver.solve(target).success());
  // And what the joint does not move is out of its reach.
  target.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  EXPECT_EQ(solver.solve(target).status, Status::out_of_reach);
}

TEST(Solver, BringsAnglesInsideTheLimitsByWholeTurns) {
  const Robot& robot = ur3();
  const Solver& solver = iksel_test::solver("ur3_wrs");
  const Eigen::MatrixXd q = robot.random_configurations(50, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    JointVector seed = q.row(i);
    const Pose target = robot.fk(seed);
    for (const int j : {0, 1, 3, 4, 5}) seed[j] += (i % 2 == 0 ? 1 : -1) * 4 * M_PI;
    const Result result = iksel_test::solve_from(solver, target, seed);
    ASSERT_TRUE(result.success());
    EXPECT_EQ(result.attempts, 1);
    EXPECT_TRUE(robot.within_limits(result.q));
  }
}

TEST(Solver, AtItsLimitsAPoseIsStillReached) {
  for (const std::string& name : iksel_test::paper_robots()) {
    const Robot& robot = iksel_test::robot(name);
    const Solver& solver = iksel_test::solver(name);
    const Eigen::MatrixXd q = robot.random_configurations(200, iksel_test::seed());
    int solved = 0;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      JointVector at = q.row(i);
      const int joint = static_cast<int>(i) % robot.dof();
      at[joint] = i % 2 == 0 ? robot.lower()[joint] : robot.upper()[joint];
      const Result result = solver.solve(robot.fk(at));
      solved += result.success();
      if (result.success()) {
        EXPECT_TRUE(robot.within_limits(result.q));
      }
    }
    EXPECT_GE(solved, 190) << name;
  }
}

TEST(Solver, NearSingularPosesNeverGiveAFalseSuccess) {
  const Robot& robot = ur3();
  iksel_test::Judge judge(robot);
  const Solver& solver = iksel_test::solver("ur3_wrs");
  const Eigen::MatrixXd q = robot.random_configurations(300, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    JointVector at = q.row(i);
    at[i % 2 == 0 ? 2 : 4] = 1e-7 * static_cast<double>(i % 10);  // elbow or wrist stretched
    const Pose target = robot.fk(at);
    const Result result = solver.solve(target);
    if (result.success()) judge.expect_solution(target, result.q);
  }
}

TEST(Solver, ThePaperIteratesByKdlAndGivesTheSameAnswersByTheKernel) {
  const Robot& robot = ur3();
  SolverOptions options = SolverOptions::paper();
  options.database.scale = iksel::Scale::small;
  EXPECT_EQ(iksel_test::paper_of(options).kinematics, iksel::Kinematics::kdl);
  const Solver kdl(robot, options);
  iksel_test::paper_of(options).kinematics = iksel::Kinematics::kernel;
  const Solver kernel(robot, options, kdl.database());
  const Eigen::MatrixXd q = robot.random_configurations(300, iksel_test::seed());
  int same = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Result a = kernel.solve(robot.fk(q.row(i)));
    const Result b = kdl.solve(robot.fk(q.row(i)));
    same += a.status == b.status && (!a.success() || (a.q - b.q).norm() < 1e-6);
  }
  EXPECT_GE(same, 297);
}

TEST(Solver, RefusesBadInput) {
  const Solver& solver = iksel_test::solver("ur3_wrs");
  Pose bad = Pose::Identity();
  bad.linear() *= 2;
  EXPECT_THROW(static_cast<void>(solver.solve(bad)), iksel::InvalidArgumentError);
  EXPECT_THROW(
      static_cast<void>(iksel_test::solve_from(solver, Pose::Identity(), JointVector::Zero(5))),
      iksel::InvalidArgumentError);
  std::vector<Pose> poses(10, Pose::Identity());
  poses[7].translation().z() = std::numeric_limits<double>::infinity();
  try {
    iksel::SolveRequest request;
    request.on_invalid_pose = iksel::OnInvalidPose::raise;
    static_cast<void>(solver.solve_batch(poses, request));
    FAIL();
  } catch (const iksel::InvalidArgumentError& error) {
    EXPECT_NE(std::string(error.what()).find("poses[7]"), std::string::npos);
  }
}

TEST(Solver, BadRowsOfABatchHaveTheirOwnStatus) {
  const Solver& solver = iksel_test::solver("ur3_wrs");
  const int n = iksel_test::cases(300);
  const Eigen::MatrixXd q = solver.robot().random_configurations(n, iksel_test::seed());
  std::vector<Pose> good;
  std::vector<Pose> mixed;
  for (int i = 0; i < n; ++i) {
    good.push_back(solver.robot().fk(q.row(i)));
    if (i % 3 == 1) {
      mixed.push_back(good.back());
      mixed.back().linear() *= 1.01;
    }
    mixed.push_back(good.back());
  }
  const std::vector<Result> expected = solver.solve_batch(good);
  for (const int threads : {1, 3}) {
    const std::vector<Result> results = solver.solve_batch(mixed, {}, {}, threads);
    std::size_t row = 0;
    for (int i = 0; i < n; ++i) {
      if (i % 3 == 1) {
        EXPECT_EQ(results[row].status, iksel::Status::invalid_pose);
        EXPECT_EQ(results[row++].q.size(), 0);
      }
      EXPECT_EQ(results[row].status, expected[static_cast<std::size_t>(i)].status);
      EXPECT_EQ(results[row++].q, expected[static_cast<std::size_t>(i)].q);
    }
  }
}

TEST(SolverOptions, AreCheckedByName) {
  const Robot& robot = ur3();
  const auto refused = [&](auto change) -> std::string {
    SolverOptions options;
    change(options);
    try {
      const Solver solver(robot, options);
    } catch (const iksel::InvalidArgumentError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refused([](auto& o) { o.position_tolerance = 0; }).find("position_tolerance"),
            std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.strategy = iksel::Lanes{0}; }).find("neighbours"),
            std::string::npos);
  EXPECT_NE(
      refused([](auto& o) { iksel_test::paper_of(o).damping = std::nan(""); }).find("damping"),
      std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.max_attempts = -1; }).find("max_attempts"), std::string::npos);
  EXPECT_EQ(refused([](auto& o) { o.database.samples = 100; }), "");
}

}  // namespace
