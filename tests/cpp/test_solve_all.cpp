// SPDX-License-Identifier: BSD-3-Clause
// All solutions of a pose, against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <limits>
#include <string>
#include <vector>

#include "branches.hpp"
#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Objective;
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

/// Objectives of every kind, and what they cost where that is easily said.
std::vector<Objective> objectives(const Robot& robot, const JointVector& posture) {
  const auto cost = [](const JointVector& q) { return (q[0] - 1) * (q[0] - 1) + q[2]; };
  return {Objective::near_posture(posture), Objective::far_from_limits(),
          Objective::most_manipulable(), Objective::custom(cost),
          Objective::preferred(robot, {{robot.joint_names()[1], posture[1]}})};
}

TEST(SolveAll, TheBestByAnObjectiveComesFirst) {
  for (const char* name : {"ur3", "cvr038", "panda"}) {
    const Solver& solver = iksel_test::solver(name);
    const Robot& robot = solver.robot();
    iksel_test::Judge judge(robot);
    const Eigen::MatrixXd q = robot.random_configurations(20, iksel_test::seed());
    for (int i = 0; i < q.rows(); ++i) {
      const Pose target = robot.fk(q.row(i));
      const JointVector posture = q.row((i + 1) % q.rows()).transpose();
      const auto plain = solver.solve_all(target);
      for (const Objective& objective : objectives(robot, posture)) {
        SolveRequest request;
        request.objective = objective;
        const auto all = solver.solve_all(target, {}, request);
        ASSERT_TRUE(all.success()) << name << ": " << q.row(i) << ", seed " << iksel_test::seed();
        // In as many digits as the joints without weight decide in.
        for (std::size_t a = 1; a < all.all.size(); ++a) {
          EXPECT_LE(all.all[a - 1].cost, all.all[a].cost + 1e-6 * std::abs(all.all[a].cost) + 1e-6)
              << name << ", kind " << static_cast<int>(objective.kind);
        }
        for (const Result& one : all.all) {
          judge.expect_solution(target, one.q);
          if (objective.kind == Objective::Kind::posture && objective.weights.size() == 0) {
            EXPECT_NEAR(one.cost, (one.q - posture).squaredNorm() / 2, 1e-12);
          } else if (objective.kind == Objective::Kind::custom) {
            EXPECT_DOUBLE_EQ(one.cost, objective.cost(one.q));
          }
        }
        if (robot.dof() > 6) continue;
        EXPECT_EQ(all.all.size(), plain.all.size());
        const double best = solver.solve(target, request).cost;
        EXPECT_LE(all.all.front().cost, best + 1e-6 * std::abs(best) + 1e-6)
            << name << ", kind " << static_cast<int>(objective.kind) << ": " << q.row(i);
      }
    }
  }
}

TEST(SolveAll, WhatCostsInfinitelyMuchIsRefused) {
  const Solver& solver = iksel_test::solver("ur3");
  const Pose target = solver.robot().fk(JointVector::Constant(6, 0.7));
  SolveRequest request;
  request.objective = Objective::custom([](const JointVector& q) {
    return q[0] > 0 ? q[1] : std::numeric_limits<double>::infinity();
  });
  const auto some = solver.solve_all(target, {}, request);
  ASSERT_TRUE(some.success());
  for (const Result& one : some.all) EXPECT_GT(one.q[0], 0);
  request.objective =
      Objective::custom([](const JointVector&) { return std::numeric_limits<double>::infinity(); });
  const auto none = solver.solve_all(target, {}, request);
  EXPECT_TRUE(none.all.empty());
  EXPECT_EQ(none.status, iksel::Status::rejected);
  iksel::SolveAllOptions options;
  options.order = iksel::SolutionOrder::manipulability;
  EXPECT_THROW((void)solver.solve_all(target, options, request), iksel::InvalidArgumentError);
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
