// SPDX-License-Identifier: BSD-3-Clause
// Laws of solves with wishes, against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iksel/iksel.hpp>
#include <iostream>
#include <stdexcept>

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

constexpr double kTwoPi = 6.28318530717958647692;

bool turns(const Robot& robot, int j) {
  return robot.joint_types()[static_cast<std::size_t>(j)] != iksel::JointType::prismatic &&
         robot.upper()[j] - robot.lower()[j] >= kTwoPi;
}

/// The largest difference of a joint, whole turns counting nothing.
double distance(const Robot& robot, const JointVector& a, const JointVector& b) {
  double largest = 0;
  for (int j = 0; j < robot.dof(); ++j) {
    const double d = a[j] - b[j];
    largest = std::max(largest, std::abs(turns(robot, j) ? std::remainder(d, kTwoPi) : d));
  }
  return largest;
}

/// The length of the shortest move from near to q or a copy of it inside the limits.
double shortest_move(const Robot& robot, const JointVector& q, const JointVector& near,
                     iksel::MoveNorm norm) {
  JointVector move = q - near;
  for (int j = 0; j < robot.dof(); ++j) {
    if (!turns(robot, j)) continue;
    for (int k = -3; k <= 3; ++k) {
      const double copy = q[j] + k * kTwoPi;
      if (copy < robot.lower()[j] || copy > robot.upper()[j]) continue;
      if (std::abs(copy - near[j]) < std::abs(move[j])) move[j] = copy - near[j];
    }
  }
  return norm == iksel::MoveNorm::two ? move.norm() : move.cwiseAbs().maxCoeff();
}

/// Every solution that is found from each of n random seeds alone.
std::vector<JointVector> brute_force(const Solver& solver, const Pose& target, int n) {
  std::vector<JointVector> found;
  const Eigen::MatrixXd seeds =
      solver.robot().random_configurations(static_cast<std::size_t>(n), iksel_test::seed() + 99);
  for (int i = 0; i < n; ++i) {
    SolveRequest request;
    request.seeds = {seeds.row(i).transpose()};
    request.database_seeds = false;
    const Result result = solver.solve(target, request);
    if (!result.success()) continue;
    const bool known = std::any_of(found.begin(), found.end(), [&](const JointVector& q) {
      return distance(solver.robot(), q, result.q) < 0.02;
    });
    if (!known) found.push_back(result.q);
  }
  return found;
}

JointVector noisy(const JointVector& q, iksel::Matrix noise, Eigen::Index i, double scale) {
  return q + scale * JointVector(noise.row(i).transpose());
}

void expect_solution(const Solver& solver, const Pose& target, const JointVector& q) {
  const auto error = iksel::pose_error(target, solver.robot().fk(q, iksel::Kinematics::kdl));
  EXPECT_LE(error.head<3>().norm(), 1.0001e-6);
  EXPECT_LE(error.tail<3>().norm(), 1.0001e-6);
  EXPECT_TRUE(solver.robot().within_limits(q));
}

const iksel_test::RobotCase& robot_case(const char* name) {
  for (const auto& c : iksel_test::all_robots()) {
    if (std::string(c.name) == name) return c;
  }
  throw std::runtime_error(name);
}

class SixJoints : public testing::TestWithParam<const char*> {};

TEST_P(SixJoints, AllBranchesOfBruteForceAreFoundAndNoOther) {
  const Solver solver(iksel_test::load(robot_case(GetParam())));
  const int n = iksel_test::cases(300) / 15;
  const Eigen::MatrixXd q = solver.robot().random_configurations(n, iksel_test::seed());
  int missed = 0;
  for (int i = 0; i < n; ++i) {
    const Pose target = solver.robot().fk(q.row(i));
    const auto all = solver.solve_all(target);
    ASSERT_TRUE(all.success());
    for (const Result& one : all.all) expect_solution(solver, target, one.q);
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

TEST_P(SixJoints, NearestIsNearestOfBruteForce) {
  const Solver solver(iksel_test::load(robot_case(GetParam())));
  const Robot& robot = solver.robot();
  const int n = iksel_test::cases(300) / 15;
  const Eigen::MatrixXd q = robot.random_configurations(n, iksel_test::seed());
  const iksel::Matrix noise = robot.random_configurations(n, iksel_test::seed() + 1);
  int farther = 0;
  for (int i = 0; i < n; ++i) {
    const JointVector from = q.row(i).transpose();
    SolveRequest request;
    request.near = noisy(from, noise, i, 0.3);
    request.norm = i % 2 == 0 ? iksel::MoveNorm::two : iksel::MoveNorm::max;
    const Pose target = robot.fk(from);
    const Result result = solver.solve(target, request);
    ASSERT_TRUE(result.success());
    expect_solution(solver, target, result.q);
    double best = shortest_move(robot, from, *request.near, request.norm);
    for (const JointVector& known : brute_force(solver, target, 1000)) {
      best = std::min(best, shortest_move(robot, known, *request.near, request.norm));
    }
    EXPECT_NEAR(result.move, shortest_move(robot, result.q, *request.near, request.norm), 1e-12);
    farther += result.move > best + 1e-3;
  }
  EXPECT_LE(farther, 1) << "of " << n << " poses, seed " << iksel_test::seed();
}

INSTANTIATE_TEST_SUITE_P(Robots, SixJoints, testing::Values("ur3", "cvr038", "cvrb1213"));

TEST(SolveAll, WholeTurnsAreAllCopiesInsideTheLimits) {
  const Solver solver(iksel_test::load(robot_case("ur3")));
  const Robot& robot = solver.robot();
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
    for (const Result& one : copies.all) expect_solution(solver, target, one.q);
  }
}

TEST(SolveAll, MaxMinDistanceAndOrderHold) {
  for (const char* name : {"ur3", "panda"}) {
    const Solver solver(iksel_test::load(robot_case(name)));
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

TEST(Near, MayLieOutsideTheLimits) {
  for (const char* name : {"panda", "ur3", "cvr038"}) {
    const Solver solver(iksel_test::load(robot_case(name)));
    const Robot& robot = solver.robot();
    const Eigen::MatrixXd q = robot.random_configurations(50, iksel_test::seed());
    for (int i = 0; i < 50; ++i) {
      JointVector at_limit = q.row(i).transpose();
      const int joint = i % robot.dof();
      at_limit[joint] = robot.upper()[joint];
      SolveRequest request;
      request.near = at_limit;
      (*request.near)[joint] += 1e-3;
      const Pose target = robot.fk(at_limit);
      const Result result = solver.solve(target, request);
      ASSERT_TRUE(result.success()) << name;
      expect_solution(solver, target, result.q);
      // A UR's elbow is singular at its limit: within the tolerances it may be some mrad away.
      EXPECT_LE(result.move, 2e-2) << name << " joint " << joint;
    }
  }
}

TEST(Near, RedundantArmHasSlidToALocalMinimum) {
  for (const char* name : {"panda", "iiwa14"}) {
    const Solver solver(iksel_test::load(robot_case(name)));
    const Robot& robot = solver.robot();
    const int n = iksel_test::cases(300) / 10;
    const Eigen::MatrixXd q = robot.random_configurations(n, iksel_test::seed());
    const iksel::Matrix noise = robot.random_configurations(n, iksel_test::seed() + 1);
    for (int i = 0; i < n; ++i) {
      SolveRequest request;
      request.near = noisy(q.row(i).transpose(), noise, i, 0.2);
      const Pose target = robot.fk(q.row(i));
      const Result result = solver.solve(target, request);
      ASSERT_TRUE(result.success());
      expect_solution(solver, target, result.q);
      // Along the self-motion the move grows in both directions, or a limit is in the way.
      const Eigen::MatrixXd J = robot.jacobian(result.q);
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeFullV);
      if (svd.singularValues()[5] < 0.02) continue;
      const JointVector along = svd.matrixV().col(6);
      const double slope = along.dot(result.q - *request.near);
      const JointVector step = -std::copysign(1e-4, slope) * along;
      const bool blocked = !robot.within_limits(result.q + step);
      EXPECT_TRUE(blocked || std::abs(slope) < 1e-3 * std::max(1.0, result.move))
          << name << " pose " << i << ": slope " << slope << ", seed " << iksel_test::seed();
    }
  }
}

TEST(Filter, FindsWheneverSolveAllHasOneThatPasses) {
  for (const char* name : {"ur3", "ur10e", "cvr038", "cvrb1213", "panda", "irb14050"}) {
    const Solver solver(iksel_test::load(robot_case(name)));
    const Robot& robot = solver.robot();
    const int n = iksel_test::cases(300) / 2;
    const Eigen::MatrixXd q = robot.random_configurations(n, iksel_test::seed());
    int passed = 0;
    int rejected = 0;
    for (int i = 0; i < n; ++i) {
      const Pose target = robot.fk(q.row(i));
      const auto passes = [](const JointVector& at) { return at[1] <= 0; };
      iksel::SolveAllOptions options;
      options.whole_turns = true;
      options.max = 10'000;
      const auto all = solver.solve_all(target, options);
      const bool any = std::any_of(all.all.begin(), all.all.end(),
                                   [&](const Result& one) { return passes(one.q); });
      SolveRequest request;
      request.filter = iksel::filter_each(robot.dof(), passes);
      if (i % 2 == 1) request.near = q.row(i).transpose();
      const Result result = solver.solve(target, request);
      if (any) EXPECT_TRUE(result.success()) << name << " pose " << i;
      if (!result.success()) EXPECT_EQ(result.status, Status::rejected);
      if (result.success()) {
        EXPECT_LE(result.q[1], 0);
        expect_solution(solver, target, result.q);
      }
      passed += result.success();
      rejected += !result.success();
    }
    EXPECT_GT(passed, 0);
    if (std::string(name) == "cvrb1213") EXPECT_GT(rejected, 0);
  }
}

TEST(Filter, NearestIsNearestOfAllThatPass) {
  // The filter lets through what lies on one side of `near` in one joint, so that often the nearest
  // that passes is a whole turn away from the nearest.
  const Solver solver(iksel_test::load(robot_case("ur3")));
  const Robot& robot = solver.robot();
  const int n = iksel_test::cases(300);
  const Eigen::MatrixXd q = robot.random_configurations(n, iksel_test::seed());
  const iksel::Matrix noise = robot.random_configurations(n, iksel_test::seed() + 1);
  int turned = 0;
  int farther = 0;
  for (int i = 0; i < n; ++i) {
    const JointVector near = noisy(q.row(i).transpose(), noise, i, 0.1);
    const int joint = i % 6;
    const auto passes = [&](const JointVector& at) { return at[joint] <= near[joint] - 1; };
    SolveRequest request;
    request.near = near;
    request.filter = iksel::filter_each(robot.dof(), passes);
    const Pose target = robot.fk(q.row(i));
    iksel::SolveAllOptions options;
    options.whole_turns = true;
    options.max = 100'000;
    const auto all = solver.solve_all(target, options, request);
    const Result result = solver.solve(target, request);
    ASSERT_GE(result.success(), all.success()) << "pose " << i;
    if (!result.success()) continue;
    expect_solution(solver, target, result.q);
    EXPECT_TRUE(passes(result.q));
    if (!all.success()) continue;
    farther += result.move > all.all.front().move + 2e-3;
    turned += result.move > 4;
  }
  EXPECT_LE(farther, n / 100) << "seed " << iksel_test::seed();
  EXPECT_GT(turned, 0);
}

TEST(Seeds, AreRankedAndComeFirst) {
  for (const bool paper : {false, true}) {
    iksel::SolverOptions options = paper ? iksel::SolverOptions::paper() : iksel::SolverOptions();
    options.database.scale = iksel::Scale::small;
    const Solver solver(iksel_test::load(robot_case("cvr038")), options);
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
    const Solver solver(iksel_test::load(robot_case("ur3")), options);
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
    const Solver solver(iksel_test::load(robot_case("ur3")), options);
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
  options.candidates = 10;
  const Solver solver(iksel_test::load(robot_case("cvr038")), options);
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

TEST(Deadline, EndsTheSearch) {
  const Solver solver(iksel_test::load(robot_case("ur3")));
  const Pose target = solver.robot().fk(JointVector::Constant(6, 0.5));
  SolveRequest request;
  request.deadline = 1e-9;
  const Result result = solver.solve(target, request);
  EXPECT_EQ(result.status, Status::out_of_time);
  EXPECT_EQ(result.attempts, 0);
  request.deadline = 1e9;
  EXPECT_TRUE(solver.solve(target, request).success());
}

TEST(Requests, SameInputSameBits) {
  for (const char* name : {"ur3", "panda"}) {
    const Solver solver(iksel_test::load(robot_case(name)));
    const Eigen::MatrixXd q = solver.robot().random_configurations(50, iksel_test::seed());
    std::vector<JointVector> first;
    for (int repeat = 0; repeat < 2; ++repeat) {
      for (int i = 0; i < 50; ++i) {
        SolveRequest request;
        request.near = q.row((i + 1) % 50).transpose();
        const Result result = solver.solve(solver.robot().fk(q.row(i)), request);
        ASSERT_TRUE(result.success());
        if (repeat == 0) {
          first.push_back(result.q);
        } else {
          EXPECT_EQ(first[static_cast<std::size_t>(i)], result.q);
        }
      }
    }
  }
}

TEST(Requests, WithoutWishesAreThePlainSolve) {
  const Solver solver(iksel_test::load(robot_case("panda")));
  const Eigen::MatrixXd q = solver.robot().random_configurations(50, iksel_test::seed());
  SolveRequest request;
  request.weights = JointVector::Constant(7, 2.0);
  request.norm = iksel::MoveNorm::max;
  for (int i = 0; i < 50; ++i) {
    const Pose target = solver.robot().fk(q.row(i));
    EXPECT_EQ(solver.solve(target, request).q, solver.solve(target).q);
  }
}

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
    const Solver solver(iksel_test::load(robot_case(name)));
    const Batch batch(solver.robot(), iksel_test::cases(300) / 5);
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
    const Solver solver(iksel_test::load(robot_case(name)), options);
    const Robot& robot = solver.robot();
    const Batch batch(robot, iksel_test::cases(300));
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
      EXPECT_EQ(most, std::min<std::size_t>(256, rows.size()));
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
        expect_solution(solver, batch.targets[i], rows[i].q);
        EXPECT_LE(rows[i].q[1], 0);
        // Of a redundant arm the nearest are local minima, of which there are many.
        if (with_near && robot.dof() == 6) EXPECT_NEAR(rows[i].move, one.move, 2e-3) << i;
      }
      EXPECT_GT(passed, 0);
    }
  }
}

TEST(RequestBatch, ExceptionsOfAFilterReachTheCaller) {
  const Solver solver(iksel_test::load(robot_case("ur3")));
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
  const Solver solver(iksel_test::load(robot_case("ur3")));
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

/// FK by KDL at q less its whole turns, which an extended double takes off without loss.
Pose exact_pose(const Robot& robot, const JointVector& q) {
  constexpr long double kTurn = 6.283185307179586476925286766559L;
  JointVector reduced = q;
  for (int j = 0; j < robot.dof(); ++j) {
    if (robot.joint_types()[static_cast<std::size_t>(j)] == iksel::JointType::prismatic) continue;
    const long double angle = q[j];
    reduced[j] = static_cast<double>(angle - kTurn * std::round(angle / kTurn));
  }
  return robot.fk(reduced, iksel::Kinematics::kdl);
}

TEST(Angles, FarFromZeroAreRightOrRefused) {
  for (const char* name : {"ur3", "panda"}) {
    for (const double tolerance : {1e-6, 1e-9}) {
      iksel::SolverOptions options;
      options.position_tolerance = tolerance;
      options.rotation_tolerance = tolerance;
      const Solver solver(iksel_test::load(robot_case(name)).without_limits(), options);
      const Robot& robot = solver.robot();
      const int n = iksel_test::cases(300) / 15;
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
            const auto error = iksel::pose_error(target, exact_pose(robot, one.q));
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
  const Solver solver(iksel_test::load(robot_case("ur3")).without_limits());
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
  expect_named("seed[3]", [&] { (void)solver.solve(target, far); });
  expect_named("posture[3]", [&] { (void)solver.solve(target, posture); });
  expect_named("start[3]", [&] { (void)solver.solve_path({target}, path); });
  expect_named("start[3]", [&] { (void)iksel::Tracker(solver, far); });
}

/// With one attempt, and a seed or three that lead nowhere, the database's best is tried too.
TEST(Requests, GivenSeedsComeOnTopOfMaxAttempts) {
  const Robot robot = iksel_test::load(robot_case("ur3"));
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
      EXPECT_EQ(solver.solve(none, JointVector::Constant(6, 0.1)).attempts, most + 1);
      SolveRequest request;
      request.near = JointVector::Constant(6, 0.1);
      EXPECT_EQ(solver.solve(none, request).attempts, most + 1);
      EXPECT_EQ(solver.solve_all(none, {}, request).attempts, most + 1);
      for (int n = 0; n < 3; ++n) request.seeds.emplace_back(JointVector::Constant(6, 0.2 * n));
      const int given = 1 + std::min(most, 3);
      EXPECT_EQ(solver.solve(none, request).attempts, most + given);
      EXPECT_EQ(solver.solve_all(none, {}, request).attempts, most + given);
      EXPECT_EQ(solver.solve_batch({none}, request)[0].attempts, most + given);
      request.database_seeds = false;
      EXPECT_EQ(solver.solve(none, request).attempts, given);
      request = {};
      request.task = iksel::Task::free_spin(iksel::Axis::z);
      request.seeds = {JointVector::Zero(6)};
      EXPECT_EQ(solver.solve(none, request).attempts, most + 1);
    }
  }
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

TEST(Requests, BadOptionsOfSolveAllAreNamed) {
  const Solver solver(iksel_test::load(robot_case("ur3")));
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

TEST(Requests, BadOnesAreNamed) {
  const Solver solver(iksel_test::load(robot_case("ur3")));
  const Pose target = Pose::Identity();
  const auto expect_error = [&](const SolveRequest& request, const std::string& what) {
    try {
      (void)solver.solve(target, request);
      FAIL() << what;
    } catch (const iksel::InvalidArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  SolveRequest request;
  request.near = JointVector::Zero(5);
  expect_error(request, "near");
  request = {};
  request.weights = JointVector::Constant(6, -1.0);
  expect_error(request, "weights[0]");
  request.weights = JointVector::Zero(6);
  expect_error(request, "weights");
  request = {};
  request.seeds = {JointVector::Zero(6), JointVector::Constant(6, NAN)};
  expect_error(request, "seeds[1]");
  request = {};
  request.near = JointVector::Constant(6, NAN);
  expect_error(request, "near");
  request = {};
  request.weights = JointVector::Constant(6, NAN);
  expect_error(request, "weights");
  request.weights = JointVector::Ones(7);
  expect_error(request, "weights");
  request = {};
  request.norm = static_cast<iksel::MoveNorm>(7);
  expect_error(request, "norm: not a value of MoveNorm (two, max)");
  request = {};
  for (const double deadline : {0.0, -1.0, double(NAN)}) {
    request.deadline = deadline;
    expect_error(request, "deadline");
  }
}

TEST(Filter, IsAskedAboutSoManyTurnsAtMost) {
  // Six joints of 31 turns each have nearly 10^9 copies of every solution.
  std::string urdf = "<robot name=\"turns\"><link name=\"l0\"/>";
  for (int i = 0; i < 6; ++i) {
    const std::string a = "l" + std::to_string(i);
    const std::string b = "l" + std::to_string(i + 1);
    urdf +=
        "<link name=\"" + b + "\"/><joint name=\"j" + b + "\" type=\"revolute\"><parent link=\"" +
        a + "\"/><child link=\"" + b + "\"/><origin xyz=\"0.1 0.05 0.2\" rpy=\"1.57 0.2 0\"/>" +
        "<axis xyz=\"0 0 1\"/><limit lower=\"-100\" upper=\"100\" velocity=\"1\" effort=\"1\"/>" +
        "</joint>";
  }
  const Solver solver(Robot::from_urdf_string(urdf + "</robot>"));
  std::size_t asked = 0;
  SolveRequest request;
  request.filter = [&](const double* /*q*/, std::size_t count, bool* keep) {
    asked += count;
    if (asked > 1'000'000) throw std::runtime_error("asked for ever");
    std::fill_n(keep, count, false);
  };
  const Pose target = solver.robot().fk(solver.robot().random_configurations(1, 1).row(0));
  EXPECT_EQ(solver.solve(target, request).status, Status::rejected);
  EXPECT_GT(asked, 1'000U);
}

}  // namespace
