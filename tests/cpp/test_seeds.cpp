// SPDX-License-Identifier: BSD-3-Clause
// Seeds that a call brings along.
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <iksel/iksel.hpp>
#include <optional>

#include "branches.hpp"
#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Matrix;
using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;
using iksel::Status;
using iksel_test::distance;

TEST(Seeds, AreRankedAndComeFirst) {
  for (const bool paper : {false, true}) {
    iksel::SolverOptions options = paper ? iksel::SolverOptions::paper() : iksel::SolverOptions();
    options.database.scale = iksel::Scale::small;
    const Solver solver(iksel_test::robot("cvr038"), options);
    const Robot& robot = solver.robot();
    const Eigen::MatrixXd q = robot.random_configurations(21, iksel_test::seed());
    const JointVector middle = (robot.lower() + robot.upper()) / 2;
    for (int i = 0; i < 20; ++i) {
      // Away from the limits, so that the predicted end of a good seed is inside.
      const JointVector goal = 0.8 * JointVector(q.row(i).transpose()) + 0.2 * middle;
      SolveRequest request;
      request.database_seeds = false;
      request.seeds = {JointVector(q.row(20).transpose()),
                       goal + JointVector::Constant(robot.dof(), 1e-3)};
      const Result result = solver.solve(robot.fk(goal), request);
      ASSERT_TRUE(result.success()) << i;
      EXPECT_LE(distance(robot, result.q, goal), 0.05);
      if (paper) EXPECT_EQ(result.attempts, 1);
      request.seeds.clear();
      EXPECT_EQ(solver.solve(robot.fk(goal), request).attempts, 0);
    }
  }
}

/// Processor time of this thread [s].
double thread_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seeds for a target, given or not, that nothing leads to but its own database.
SolveRequest request_of(const Matrix& seeds, Eigen::Index count) {
  SolveRequest request;
  request.database_seeds = false;
  for (Eigen::Index i = 0; i < count; ++i) request.seeds.push_back(seeds.row(i).transpose());
  return request;
}

/// A pose within reach that is none of the arm's.
Pose unreachable(const Solver& solver) {
  Pose target = solver.robot().fk(JointVector::Zero(solver.robot().dof()));
  target.translation() = solver.robot().reach_centre();
  return target;
}

TEST(Seeds, CostInProportionToTheirNumber) {
  constexpr Eigen::Index kFew = 2000;
  for (const int kind : {0, 1, 2}) {
    iksel::SolverOptions options =
        kind == 1 ? iksel::SolverOptions::paper() : iksel::SolverOptions();
    options.database.scale = iksel::Scale::small;
    options.max_attempts = 1'000'000;
    options.max_iterations = 1;
    const Solver solver(iksel_test::robot("ur3"), options);
    const Matrix seeds = solver.robot().random_configurations(8 * kFew, iksel_test::seed());
    double seconds[2];
    for (int size = 0; size < 2; ++size) {
      SolveRequest request = request_of(seeds, size == 0 ? kFew : 8 * kFew);
      if (kind == 2) request.task = iksel::Task::free_spin();
      const double start = thread_seconds();
      const Result result = solver.solve(unreachable(solver), request);
      seconds[size] = thread_seconds() - start;
      EXPECT_FALSE(result.success());
      EXPECT_EQ(static_cast<std::size_t>(result.attempts), request.seeds.size());
    }
    EXPECT_LT(seconds[1], 20 * seconds[0]) << "8 times the seeds, 64 times if by the square";
  }
}

TEST(Seeds, EndAtTheDeadline) {
  for (const bool paper : {false, true}) {
    iksel::SolverOptions options = paper ? iksel::SolverOptions::paper() : iksel::SolverOptions();
    options.database.scale = iksel::Scale::small;
    options.max_attempts = 1'000'000;
    const Solver solver(iksel_test::robot("ur3"), options);
    const Matrix seeds = solver.robot().random_configurations(32000, iksel_test::seed());
    SolveRequest request = request_of(seeds, seeds.rows());
    for (const double deadline : {1e-9, 1e-3, 1e-2}) {
      request.deadline = deadline;
      for (const bool of_task : {false, true}) {
        request.task = of_task ? std::optional(iksel::Task::free_spin()) : std::nullopt;
        const double start = thread_seconds();
        const Result result = solver.solve(unreachable(solver), request);
        // 32,000 isfinite() and the like are not part of the search.
        EXPECT_LT(thread_seconds() - start, deadline + 0.02);
        EXPECT_EQ(result.status, Status::out_of_time);
      }
    }
  }
}

TEST(Seeds, AreTriedOnceEachInAnOrderOfTheirOwn) {
  // More seeds than take part in re-selection: none is lost, whatever order they are given in.
  iksel::SolverOptions options;
  iksel_test::paper_of(options).candidates = 10;
  const Solver solver(iksel_test::robot("cvr038"), options);
  Matrix seeds = solver.robot().random_configurations(100, iksel_test::seed());
  const Pose target = solver.robot().fk(seeds.row(0));
  SolveRequest request = request_of(seeds, seeds.rows());
  const iksel::Solutions all = solver.solve_all(target, {}, request);
  ASSERT_TRUE(all.success());
  std::reverse(request.seeds.begin(), request.seeds.end());
  const iksel::Solutions again = solver.solve_all(target, {}, request);
  ASSERT_EQ(all.all.size(), again.all.size());
  for (std::size_t i = 0; i < all.all.size(); ++i) {
    EXPECT_LE(distance(solver.robot(), all.all[i].q, again.all[i].q), 1e-4);
  }
}

/// With one attempt, and a seed or three that lead nowhere, the database's best is tried too. Of a
/// robot whose search ends by its attempts alone.
TEST(Seeds, ComeOnTopOfMaxAttempts) {
  const Robot& robot = iksel_test::robot("irb14050");
  const int dof = robot.dof();
  iksel::SolverOptions fast;
  iksel::SolverOptions paper = iksel::SolverOptions::paper();
  paper.database.samples = 2000;
  paper.database.sampling = iksel::Sampling::random;
  // Above the base, where the arm reaches, but not with the flange upside down.
  Pose none = Pose::Identity();
  none.translation() << 0, 0, robot.reach() * 0.95;
  none.linear() = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()).matrix();
  for (iksel::SolverOptions options : {fast, paper}) {
    for (const int most : {1, 2, 5}) {
      options.max_attempts = most;
      const Solver solver(robot, options);
      ASSERT_FALSE(solver.solve(none).success());
      EXPECT_EQ(solver.solve(none).attempts, most);
      EXPECT_EQ(iksel_test::solve_from(solver, none, JointVector::Constant(dof, 0.1)).attempts,
                most + 1);
      SolveRequest request;
      request.near = JointVector::Constant(dof, 0.1);
      EXPECT_EQ(solver.solve(none, request).attempts, most + 1);
      EXPECT_EQ(solver.solve_all(none, {}, request).attempts, most + 1);
      for (int n = 0; n < 3; ++n) request.seeds.emplace_back(JointVector::Constant(dof, 0.2 * n));
      const int given = 1 + std::min(most, 3);
      EXPECT_EQ(solver.solve(none, request).attempts, most + given);
      EXPECT_EQ(solver.solve_all(none, {}, request).attempts, most + given);
      EXPECT_EQ(solver.solve_batch({none}, request)[0].attempts, most + given);
      request.database_seeds = false;
      EXPECT_EQ(solver.solve(none, request).attempts, given);
      request = {};
      request.task = iksel::Task::free_spin(iksel::Axis::z);
      request.seeds = {JointVector::Zero(dof)};
      EXPECT_EQ(solver.solve(none, request).attempts, most + 1);
    }
  }
}

}  // namespace
