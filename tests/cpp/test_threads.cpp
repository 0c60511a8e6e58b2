// SPDX-License-Identifier: BSD-3-Clause
// Many threads on one solver give bit for bit what one gives. Built with the thread sanitizer too.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <iksel/iksel.hpp>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <utility>

#include "base/parallel.hpp"
#include "robots.hpp"

namespace {

using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolverOptions;

void expect_same(const Result& a, const Result& b) {
  EXPECT_EQ(a.status, b.status);
  ASSERT_EQ(a.q.size(), b.q.size());
  for (Eigen::Index i = 0; i < a.q.size(); ++i) EXPECT_EQ(a.q[i], b.q[i]);
  EXPECT_EQ(a.attempts, b.attempts);
  EXPECT_EQ(a.iterations, b.iterations);
  if (a.success()) {
    EXPECT_EQ(a.position_error, b.position_error);
    EXPECT_EQ(a.rotation_error, b.rotation_error);
  }
}

std::vector<SolverOptions> presets() {
  SolverOptions paper = SolverOptions::paper();
  // What threads do to each other does not depend on the size of the database.
  paper.database.sampling = iksel::Sampling::random;
  paper.database.samples = 2000;
  SolverOptions random_restarts = paper;
  iksel_test::paper_of(random_restarts).iteration = iksel::Iteration::pinv_rr;
  SolverOptions kernel = paper;
  iksel_test::paper_of(kernel).kinematics = iksel::Kinematics::kernel;
  return {SolverOptions{}, paper, random_restarts, kernel};
}

/// Whatever the number of threads; and but for seeds in lanes, what single solves give.
TEST(Threads, BatchGivesTheSameBits) {
  for (const std::string& name : iksel_test::paper_robots()) {
    const Robot& robot = iksel_test::robot(name);
    const auto targets = iksel_test::random_targets(robot, iksel_test::cases(600, 20));
    for (const SolverOptions& options : presets()) {
      const Solver solver(robot, options);
      std::vector<Result> expected;
      if (std::holds_alternative<iksel::Lanes>(options.strategy)) {
        expected = solver.solve_batch(targets, {}, {}, 1);
      } else {
        for (const Pose& target : targets) expected.push_back(solver.solve(target));
      }
      for (const int threads : {1, 2, 8}) {
        const std::vector<Result> batch = solver.solve_batch(targets, {}, {}, threads);
        ASSERT_EQ(batch.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) expect_same(batch[i], expected[i]);
      }
    }
  }
}

/// In lanes a batch may answer with another solution than a single solve: as good, solved for the
/// same targets, and untouched by what else is in the batch.
TEST(Threads, BatchInLanesAnswersEachTargetByItself) {
  std::vector<std::string> names = iksel_test::paper_robots();
  names.insert(names.end(), {"panda", "iiwa14", "valkyrie_right_arm", "irb120", "xarm5"});
  for (const std::string& name : names) {
    const Robot& robot = iksel_test::robot(name);
    const Solver& solver = iksel_test::solver(name);
    auto targets = iksel_test::random_targets(robot, iksel_test::cases(600, 20));
    for (std::size_t i = 0; i < targets.size(); i += 7) targets[i].translation() *= 3;  // too far
    for (std::size_t i = 0; i + 1 < targets.size(); i += 5) {
      targets[i].linear() = targets[i + 1].linear().transpose();  // most without an answer
    }
    const std::vector<Result> batch = solver.solve_batch(targets, {}, {}, 1);
    std::vector<std::size_t> order(targets.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::reverse(order.begin(), order.end());
    order.erase(order.begin(), order.begin() + 13);
    std::vector<Pose> others;
    for (const std::size_t i : order) others.push_back(targets[i]);
    const std::vector<Result> shuffled = solver.solve_batch(others, {}, {}, 1);
    for (std::size_t k = 0; k < order.size(); ++k) {
      SCOPED_TRACE(name + ", target " + std::to_string(order[k]));
      expect_same(shuffled[k], batch[order[k]]);
    }
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const Result single = solver.solve(targets[i]);
      EXPECT_EQ(batch[i].status, single.status) << name << " " << i;
      EXPECT_EQ(batch[i].proof, single.proof) << name << " " << i;
      if (!single.success() || !batch[i].success()) continue;
      // Both lie within the tolerances of the target, so their poses within twice those.
      const auto apart = iksel::pose_error(robot.fk(single.q), robot.fk(batch[i].q));
      EXPECT_LE(apart.head<3>().norm(), 2 * solver.options().position_tolerance + 1e-12);
      EXPECT_LE(apart.tail<3>().norm(), 2 * solver.options().rotation_tolerance + 1e-12);
    }
  }
}

/// What was solved before leaves nothing behind.
TEST(Threads, AnswersDoNotDependOnWhatWasSolvedBefore) {
  for (const char* name : {"xarm5", "irb120", "cvr038", "panda"}) {
    const Solver& solver = iksel_test::solver(name);
    auto targets =
        iksel_test::random_targets(iksel_test::robot(name), iksel_test::cases(3000, 100));
    for (std::size_t i = 0; i + 1 < targets.size(); i += 3) {
      targets[i].linear() = targets[i + 1].linear().transpose();  // most without an answer
    }
    std::vector<Result> forwards;
    for (const Pose& target : targets) forwards.push_back(solver.solve(target));
    for (std::size_t i = targets.size(); i-- > 0;) {
      SCOPED_TRACE(std::string(name) + ", target " + std::to_string(i));
      expect_same(solver.solve(targets[i]), forwards[i]);
    }
  }
}

/// With wishes too; and the filter, which here is not safe to call twice at once, is not.
TEST(Threads, BatchWithWishesGivesTheSameBits) {
  for (const char* name : {"ur3", "panda"}) {
    const Robot& robot = iksel_test::robot(name);
    // Where nothing passes, all attempts are made.
    SolverOptions options;
    options.max_attempts = 256;
    const Solver solver(robot, options);
    const auto targets = iksel_test::random_targets(robot, iksel_test::cases(600, 20));
    std::vector<iksel::JointVector> near;
    const Eigen::MatrixXd q = robot.random_configurations(targets.size(), iksel_test::seed() + 1);
    for (Eigen::Index i = 0; i < q.rows(); ++i) near.emplace_back(q.row(i).transpose());
    std::size_t asked = 0;
    iksel::SolveRequest request;
    for (const bool filtered : {false, true}) {
      if (filtered) {
        request.filter = [&](const double* values, std::size_t count, bool* keep) {
          asked += count;
          for (std::size_t i = 0; i < count; ++i) keep[i] = values[i * robot.dof()] > 0;
        };
      }
      const std::vector<Result> expected = solver.solve_batch(targets, request, near, 1);
      const std::size_t asked_by_one = std::exchange(asked, 0);
      for (const int threads : {2, 8}) {
        const std::vector<Result> batch = solver.solve_batch(targets, request, near, threads);
        for (std::size_t i = 0; i < batch.size(); ++i) {
          expect_same(batch[i], expected[i]);
          if (batch[i].success()) EXPECT_EQ(batch[i].move, expected[i].move);
        }
        EXPECT_EQ(std::exchange(asked, 0), asked_by_one);
      }
    }
  }
}

TEST(Threads, EightThreadsShareOneSolver) {
  const Robot& robot = iksel_test::robot("irb14050");
  const auto targets = iksel_test::random_targets(robot, iksel_test::cases(400));
  for (const SolverOptions& options : presets()) {
    const Solver solver(robot, options);
    std::vector<Result> alone;
    for (const Pose& target : targets) alone.push_back(solver.solve(target));
    std::vector<std::vector<Result>> shared(8);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < shared.size(); ++t) {
      threads.emplace_back([&, t] {
        // Each in another order, so that no two are in step.
        std::vector<std::size_t> order(targets.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::shuffle(order.begin(), order.end(), std::mt19937_64(iksel_test::seed() + t));
        shared[t].resize(targets.size());
        for (const std::size_t i : order) shared[t][i] = solver.solve(targets[i]);
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto& results : shared) {
      for (std::size_t i = 0; i < alone.size(); ++i) expect_same(results[i], alone[i]);
    }
  }
}

TEST(Threads, KinematicsOfOneRobotAreShared) {
  const Robot& robot = iksel_test::robot("irb14050");
  const Eigen::MatrixXd q = robot.random_configurations(iksel_test::cases(500), iksel_test::seed());
  std::vector<std::thread> threads;
  std::atomic<int> wrong{0};
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (Eigen::Index i = 0; i < q.rows(); ++i) {
        const iksel::Jacobian J =
            robot.jacobian(q.row(i)) - robot.jacobian(q.row(i), iksel::Kinematics::kdl);
        if (J.lpNorm<Eigen::Infinity>() > 1e-12) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong.load(), 0);
}

// Sanitizers reserve address space themselves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

/// Ends with 0 if all is done where there is no room for the stacks of many threads.
[[noreturn]] void work_with_few_threads() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t most = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (1U << 26U);
  const rlimit limit{most, most};
  ::setrlimit(RLIMIT_AS, &limit);
  std::atomic<int> done{0};
  std::atomic<int> workers{0};
  iksel::parallel_for(400, 1, 200, [&] {
    ++workers;
    return [&](std::size_t, std::size_t) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      ++done;
    };
  });
  std::exit(done == 400 && workers < 200 ? 0 : 1);
}

TEST(Threads, FewerThanWereAskedForDoAll) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(work_with_few_threads(), testing::ExitedWithCode(0), "");
}

#endif

}  // namespace
