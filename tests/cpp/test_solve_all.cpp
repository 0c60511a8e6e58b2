// SPDX-License-Identifier: BSD-3-Clause
// All solutions of a pose, against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <string>

#include "branches.hpp"
#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;
using iksel_test::brute_force;
using iksel_test::distance;
using iksel_test::kTwoPi;
using iksel_test::turns;

class SolveAllOfSixJoints : public testing::TestWithParam<const char*> {};

TEST_P(SolveAllOfSixJoints, AllBranchesOfBruteForceAreFoundAndNoOther) {
  const Solver& solver = iksel_test::solver(GetParam());
  iksel_test::Judge judge(solver.robot());
  const int n = iksel_test::cases(300, 30) / 15;
  const Eigen::MatrixXd q = solver.robot().random_configurations(n, iksel_test::seed());
  int missed = 0;
  for (int i = 0; i < n; ++i) {
    const Pose target = solver.robot().fk(q.row(i));
    const auto all = solver.solve_all(target);
    ASSERT_TRUE(all.success());
    for (const Result& one : all.all) judge.expect_solution(target, one.q);
    for (std::size_t a = 0; a < all.all.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        EXPECT_GE(distance(solver.robot(), all.all[a].q, all.all[b].q), 0.01);
      }
    }
    for (const JointVector& known : brute_force(solver, target, 1000)) {
      missed += std::none_of(all.all.begin(), all.all.end(), [&](const Result& one) {
        return distance(solver.robot(), one.q, known) < 0.05;
      });
    }
  }
  EXPECT_LE(missed, 1) << "of " << n << " poses, seed " << iksel_test::seed();
}

INSTANTIATE_TEST_SUITE_P(Robots, SolveAllOfSixJoints, testing::Values("ur3", "cvr038", "cvrb1213"));

TEST(SolveAll, WholeTurnsAreAllCopiesInsideTheLimits) {
  const Solver& solver = iksel_test::solver("ur3");
  const Robot& robot = solver.robot();
  iksel_test::Judge judge(robot);
  const Eigen::MatrixXd q = robot.random_configurations(5, iksel_test::seed());
  for (int i = 0; i < 5; ++i) {
    const Pose target = robot.fk(q.row(i));
    iksel::SolveAllOptions options;
    const auto once = solver.solve_all(target, options);
    options.whole_turns = true;
    options.max = 100'000;
    const auto copies = solver.solve_all(target, options);
    std::size_t expected = 0;
    for (const Result& one : once.all) {
      std::size_t product = 1;
      for (int j = 0; j < robot.dof(); ++j) {
        std::size_t count = 0;
        for (int k = -3; k <= 3; ++k) {
          const double copy = one.q[j] + k * kTwoPi;
          count += copy >= robot.lower()[j] && copy <= robot.upper()[j] ? 1 : 0;
        }
        product *= turns(robot, j) ? count : 1;
      }
      expected += product;
    }
    EXPECT_EQ(copies.all.size(), expected);
    for (const Result& one : copies.all) judge.expect_solution(target, one.q);
  }
}

TEST(SolveAll, MaxMinDistanceAndOrderHold) {
  for (const char* name : {"ur3", "panda"}) {
    const Solver& solver = iksel_test::solver(name);
    const Eigen::MatrixXd q = solver.robot().random_configurations(20, iksel_test::seed());
    for (int i = 0; i < 20; ++i) {
      iksel::SolveAllOptions options;
      options.max = 5;
      options.min_distance = 0.2;
      SolveRequest request;
      request.near = q.row((i + 1) % 20).transpose();
      const auto some = solver.solve_all(solver.robot().fk(q.row(i)), options, request);
      ASSERT_TRUE(some.success());
      EXPECT_LE(some.all.size(), 5U);
      for (std::size_t a = 0; a < some.all.size(); ++a) {
        if (a > 0) EXPECT_GE(some.all[a].move, some.all[a - 1].move);
        for (std::size_t b = 0; b < a; ++b) {
          EXPECT_GE(distance(solver.robot(), some.all[a].q, some.all[b].q), 0.2);
        }
      }
    }
  }
}

TEST(SolveAll, BadOptionsAreNamed) {
  const Solver& solver = iksel_test::solver("ur3");
  const auto expect_error = [&](const iksel::SolveAllOptions& options, const std::string& what) {
    try {
      (void)solver.solve_all(Pose::Identity(), options);
      FAIL() << what;
    } catch (const iksel::InvalidArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  iksel::SolveAllOptions options;
  options.max = 0;
  expect_error(options, "max");
  options = {};
  for (const double distance : {0.0, -1.0, 1e9, double(NAN)}) {
    options.min_distance = distance;
    expect_error(options, "min_distance");
  }
  options = {};
  options.order = static_cast<iksel::SolutionOrder>(9);
  expect_error(options, "order: not a value of SolutionOrder (move, limit_distance");
}

}  // namespace
