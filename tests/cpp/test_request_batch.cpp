// SPDX-License-Identifier: BSD-3-Clause
// Batches with wishes are the loop over single calls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "branches.hpp"
#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;
using iksel_test::noisy;

/// Targets at random configurations, and a noisy one near each.
struct Batch {
  Batch(const Robot& robot, int n) {
    const Eigen::MatrixXd q = robot.random_configurations(n, iksel_test::seed());
    const iksel::Matrix noise = robot.random_configurations(n, iksel_test::seed() + 1);
    for (int i = 0; i < n; ++i) {
      targets.push_back(robot.fk(q.row(i)));
      near.push_back(noisy(q.row(i).transpose(), noise, i, 0.2));
    }
  }
  std::vector<Pose> targets;
  std::vector<JointVector> near;
};

TEST(RequestBatch, IsTheLoopOnAnyNumberOfThreads) {
  for (const char* name : {"ur3", "panda"}) {
    const Solver& solver = iksel_test::solver(name);
    const Batch batch(solver.robot(), iksel_test::cases(300, 10) / 5);
    for (const int threads : {1, 2, 8}) {
      const auto rows = solver.solve_batch(batch.targets, SolveRequest{}, batch.near, threads);
      ASSERT_EQ(rows.size(), batch.targets.size());
      for (std::size_t i = 0; i < rows.size(); ++i) {
        SolveRequest request;
        request.near = batch.near[i];
        const Result one = solver.solve(batch.targets[i], request);
        ASSERT_EQ(rows[i].q, one.q) << name << " row " << i << ", " << threads << " threads";
        EXPECT_EQ(rows[i].move, one.move);
        EXPECT_EQ(rows[i].attempts, one.attempts);
      }
    }
  }
}

TEST(RequestBatch, FilterIsAskedAboutManyAndFindsWhatSolveFinds) {
  for (const char* name : {"ur3", "cvrb1213", "panda"}) {
    // Where nothing passes, all attempts are made.
    iksel::SolverOptions options;
    options.max_attempts = 256;
    const Solver solver(iksel_test::robot(name), options);
    const Robot& robot = solver.robot();
    iksel_test::Judge judge(robot);
    const Batch batch(robot, iksel_test::cases(300, 20));
    std::size_t most = 0;
    SolveRequest request;
    request.filter = [&](const double* q, std::size_t count, bool* keep) {
      most = std::max(most, count);
      for (std::size_t i = 0; i < count; ++i) keep[i] = q[i * robot.dof() + 1] <= 0;
    };
    for (const bool with_near : {false, true}) {
      const auto near = with_near ? batch.near : std::vector<JointVector>();
      most = 0;
      const auto rows = solver.solve_batch(batch.targets, request, near, 1);
      // About one candidate of each row at least, and never about more than that many.
      EXPECT_LE(most, 256U);
      EXPECT_GE(most, std::min<std::size_t>(256, rows.size()));
      for (const int threads : {2, 8}) {
        const auto again = solver.solve_batch(batch.targets, request, near, threads);
        for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_EQ(rows[i].q, again[i].q);
      }
      int passed = 0;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        SolveRequest single = request;
        if (with_near) single.near = batch.near[i];
        const Result one = solver.solve(batch.targets[i], single);
        ASSERT_EQ(rows[i].status, one.status) << name << " row " << i;
        if (!one.success()) continue;
        ++passed;
        judge.expect_solution(batch.targets[i], rows[i].q);
        EXPECT_LE(rows[i].q[1], 0);
        // Of a redundant arm the nearest are local minima, of which there are many.
        if (with_near && robot.dof() == 6) EXPECT_NEAR(rows[i].move, one.move, 2e-3) << i;
      }
      EXPECT_GT(passed, 0);
    }
  }
}

TEST(RequestBatch, ExceptionsOfAFilterReachTheCaller) {
  const Solver& solver = iksel_test::solver("ur3");
  const Batch batch(solver.robot(), 600);
  SolveRequest request;
  request.filter = [](const double* /*q*/, std::size_t /*count*/, bool* /*keep*/) {
    throw std::domain_error("no map");
  };
  for (const int threads : {1, 4}) {
    EXPECT_THROW((void)solver.solve_batch(batch.targets, request, {}, threads), std::domain_error);
  }
  EXPECT_THROW((void)solver.solve(batch.targets[0], request), std::domain_error);
  EXPECT_THROW((void)solver.solve_all(batch.targets[0], {}, request), std::domain_error);
  // The solver is as good as before.
  EXPECT_TRUE(solver.solve(batch.targets[0]).success());
}

TEST(RequestBatch, BadOnesAreNamed) {
  const Solver& solver = iksel_test::solver("ur3");
  Batch batch(solver.robot(), 5);
  SolveRequest request;
  request.on_invalid_pose = iksel::OnInvalidPose::raise;
  const auto expect_error = [&](const std::string& what) {
    try {
      (void)solver.solve_batch(batch.targets, request, batch.near);
      FAIL() << what;
    } catch (const iksel::InvalidArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  batch.near[3][2] = NAN;
  expect_error("near[3]");
  batch.near.pop_back();
  expect_error("near: expected none, or one for each of the 5 poses, got 4");
  batch.near.clear();
  batch.targets[2].linear() *= 2;
  expect_error("poses[2]");
  request.on_invalid_pose = static_cast<iksel::OnInvalidPose>(7);
  expect_error("on_invalid_pose");
  request = {};
  EXPECT_EQ(solver.solve_batch(batch.targets, request)[2].status, iksel::Status::invalid_pose);
  request.weights = JointVector::Zero(6);
  EXPECT_THROW((void)solver.solve_batch(batch.targets, request), iksel::InvalidArgumentError);
}

}  // namespace
