// SPDX-License-Identifier: BSD-3-Clause
// Joint angles far from zero.
#include <gtest/gtest.h>

#include <cmath>
#include <iksel/iksel.hpp>
#include <string>

#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Matrix;
using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;

/// FK by KDL at q less its whole turns, which an extended double takes off without loss.
Pose exact_pose(const Robot& robot, iksel_test::Judge& judge, const JointVector& q) {
  constexpr long double kTurn = 6.283185307179586476925286766559L;
  JointVector reduced = q;
  for (int j = 0; j < robot.dof(); ++j) {
    if (robot.joint_types()[static_cast<std::size_t>(j)] == iksel::JointType::prismatic) continue;
    const long double angle = q[j];
    reduced[j] = static_cast<double>(angle - kTurn * std::round(angle / kTurn));
  }
  return judge.fk(reduced);
}

TEST(Angles, FarFromZeroAreRightOrRefused) {
  for (const char* name : {"ur3", "panda"}) {
    for (const double tolerance : {1e-6, 1e-9}) {
      iksel::SolverOptions options;
      options.position_tolerance = tolerance;
      options.rotation_tolerance = tolerance;
      const Solver solver(iksel_test::robot(name).without_limits(), options);
      const Robot& robot = solver.robot();
      iksel_test::Judge judge(robot);
      const int n = iksel_test::cases(300, 30) / 15;
      const Matrix q = robot.random_configurations(static_cast<std::size_t>(n), iksel_test::seed());
      int refused = 0;
      int far = 0;
      for (int i = 0; i < n; ++i) {
        const Pose target = robot.fk(q.row(i));
        for (double size = 1; size < 1e13; size *= 10) {
          SolveRequest request;
          request.near = q.row((i + 1) % n).transpose() * size;
          iksel::Solutions all;
          try {
            all = solver.solve_all(target, {}, request);
            all.all.push_back(solver.solve(target, request));
          } catch (const iksel::InvalidArgumentError& error) {
            EXPECT_NE(std::string(error.what()).find("near["), std::string::npos);
            EXPECT_GT(request.near->cwiseAbs().maxCoeff(), 100);
            ++refused;
            continue;
          }
          EXPECT_LT(size, 1e10);
          for (const Result& one : all.all) {
            if (!one.success()) continue;
            far += one.q.cwiseAbs().maxCoeff() > 1000;
            const auto error = iksel::pose_error(target, exact_pose(robot, judge, one.q));
            EXPECT_LE(error.head<3>().norm(), 1.1 * tolerance) << one.q.transpose();
            EXPECT_LE(error.tail<3>().norm(), 1.1 * tolerance) << one.q.transpose();
          }
        }
      }
      EXPECT_GT(refused, 0);
      EXPECT_GT(far, 0);
    }
  }
}

TEST(Angles, OutOfScaleAreNamedWhereverTheyComeIn) {
  const Solver solver(iksel_test::robot("ur3").without_limits());
  const Pose target = solver.robot().fk(JointVector::Constant(6, 0.5));
  JointVector far = JointVector::Constant(6, 0.5);
  far[3] = -1e10;
  const auto expect_named = [](const char* field, const auto& call) {
    try {
      call();
      ADD_FAILURE() << field;
    } catch (const iksel::InvalidArgumentError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.rfind(field, 0), 0U) << text;
      EXPECT_NE(text.find("wrist_1_joint"), std::string::npos) << text;
    }
  };
  SolveRequest near;
  near.near = far;
  SolveRequest seeds;
  seeds.seeds = {JointVector::Zero(6), far};
  SolveRequest posture;
  posture.objective = iksel::Objective::near_posture(far);
  iksel::PathOptions path;
  path.start = far;
  expect_named("near[3]", [&] { (void)solver.solve(target, near); });
  expect_named("near[3]", [&] { (void)solver.solve_all(target, {}, near); });
  expect_named("near[3]", [&] { (void)solver.diagnose(target, near); });
  expect_named("near[3]", [&] { (void)solver.solve_batch({target}, near); });
  expect_named("near[1][3]", [&] {
    (void)solver.solve_batch({target, target}, {}, {JointVector::Zero(6), far});
  });
  expect_named("seeds[1][3]", [&] { (void)solver.solve(target, seeds); });
  expect_named("posture[3]", [&] { (void)solver.solve(target, posture); });
  expect_named("start[3]", [&] { (void)solver.solve_path({target}, path); });
  expect_named("start[3]", [&] { (void)iksel::Tracker(solver, far); });
}

/// A joint may turn by what another slides, which is metres.
TEST(Angles, ThoseThatFollowASlideAreBoundedToo) {
  const auto robot = [](const std::string& limit) {
    return Robot::from_urdf_string(
        "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><joint name='slide' "
        "type='prismatic'><parent link='a'/><child link='b'/><limit lower='-1' upper='" +
        limit +
        "' velocity='1' effort='1'/></joint><joint name='turn' type='continuous'><parent "
        "link='b'/><child link='c'/><origin xyz='1000 0 0'/><mimic joint='slide'/></joint>"
        "</robot>");
  };
  const Solver fine(robot("100"));
  // Which looks beyond the limits.
  EXPECT_NO_THROW((void)fine.diagnose(Pose::Identity()));
  try {
    const Solver solver(robot("1e7"));
    FAIL();
  } catch (const iksel::InvalidArgumentError& error) {
    EXPECT_NE(std::string(error.what()).find("upper limit[0] (joint 'slide'): 1e+07 m, by which"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
