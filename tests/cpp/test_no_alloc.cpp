// SPDX-License-Identifier: BSD-3-Clause
// Solving takes nothing from the heap once the solver stands. The heap is watched by this program's
// own malloc, in front of the C library's.
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <iksel/iksel.hpp>
#include <optional>

#include "closed_chains.hpp"
#include "robots.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {
std::atomic<bool> watching{false};
std::atomic<int> allocations{0};

void count() {
  if (watching.load(std::memory_order_relaxed)) ++allocations;
}
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t n, std::size_t size);
void* __libc_realloc(void* p, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  count();
  return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t size) {
  count();
  return __libc_realloc(p, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  count();
  *out = __libc_memalign(alignment, size);
  return *out == nullptr ? 12 : 0;
}
}

namespace {

TEST(NoAllocation, TheWatchSeesAllocations) {
  allocations = 0;
  watching = true;
  const auto p = std::make_unique<std::vector<int>>(1000);
  watching = false;
  EXPECT_GE(allocations.load(), 2);
}

class HeapFreeSchemes : public testing::TestWithParam<iksel::Iteration> {};

TEST_P(HeapFreeSchemes, SolveWithoutTheHeap) {
  for (const std::string& name : iksel_test::paper_robots()) {
    const iksel::Robot& robot = iksel_test::robot(name);
    iksel::SolverOptions options = iksel::SolverOptions::paper();
    options.database.scale = iksel::Scale::small;
    options.max_attempts = 10;
    iksel::Paper& paper = iksel_test::paper_of(options);
    paper.iteration = GetParam();
    paper.rotation_difference = iksel::RotationDifference::geodesic;
    paper.limit_aware = true;
    paper.whole_turns = true;
    const iksel::Solver solver(robot, options);
    const Eigen::MatrixXd q = robot.random_configurations(100, iksel_test::seed());
    std::vector<iksel::Pose> targets;
    for (Eigen::Index i = 0; i < q.rows(); ++i) targets.push_back(robot.fk(q.row(i)));
    iksel::SolveRequest seed;
    seed.seeds = {iksel::JointVector::Zero(robot.dof())};

    allocations = 0;
    watching = true;
    int solved = 0;
    for (const iksel::Pose& target : targets) {
      solved += solver.solve(target).success();
      solved += solver.solve(target, seed).success();
    }
    watching = false;
    EXPECT_EQ(allocations.load(), 0) << name;
    EXPECT_GT(solved, 50);
  }
}

TEST(NoAllocation, TasksSolveWithoutTheHeap) {
  const iksel::Robot& robot = iksel_test::robot("irb14050");
  for (const iksel::Task& task : {iksel::Task::position_only(), iksel::Task::free_spin(),
                                  iksel::Task::box({0.01, 0.01, 0.01}, {0.1, 0.1, 0.1})}) {
    iksel::SolverOptions options;
    options.task = task;
    const iksel::Solver solver(robot, options);
    const Eigen::MatrixXd q = robot.random_configurations(100, iksel_test::seed());
    std::vector<iksel::Pose> targets;
    for (Eigen::Index i = 0; i < q.rows(); ++i) targets.push_back(robot.fk(q.row(i)));
    allocations = 0;
    watching = true;
    int solved = 0;
    for (const iksel::Pose& target : targets) solved += solver.solve(target).success();
    watching = false;
    EXPECT_EQ(allocations.load(), 0);
    EXPECT_EQ(solved, 100);
  }
}

TEST(NoAllocation, NearFilteredAndTracking) {
  for (const char* name : {"ur3", "panda", "cvr038"}) {
    const iksel::Robot& robot = iksel_test::robot(name);
    const iksel::Solver& solver = iksel_test::solver(name);
    const Eigen::MatrixXd q = robot.random_configurations(100, iksel_test::seed());
    std::vector<iksel::Pose> targets;
    for (Eigen::Index i = 0; i < q.rows(); ++i) targets.push_back(robot.fk(q.row(i)));
    iksel::SolveRequest near;
    iksel::SolveRequest filtered;
    filtered.filter =
        iksel::filter_each(robot.dof(), [](const iksel::JointVector& at) { return at[0] > at[1]; });
    iksel::Tracker tracker(solver, q.row(0).transpose(), std::nullopt, {},
                           iksel::Objective::far_from_limits());

    allocations = 0;
    watching = true;
    int solved = 0;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const iksel::Pose& target = targets[static_cast<std::size_t>(i)];
      near.near = q.row((i + 1) % q.rows()).transpose();
      near.norm = i % 2 == 0 ? iksel::MoveNorm::two : iksel::MoveNorm::max;
      solved += solver.solve(target).success();
      solved += solver.solve(target, near).success();
      solved += solver.solve(target, filtered).success();
      (void)tracker.track(target, 0.1);
    }
    watching = false;
    EXPECT_EQ(allocations.load(), 0) << name;
    EXPECT_GT(solved, 200);
  }
}

/// Six joints in closed form, by a sweep, and with axes that lie anyhow; seven by a sweep.
TEST(NoAllocation, PosesWithoutAnAnswer) {
  iksel_test::Dice dice(iksel_test::seed());
  const iksel::Robot any = iksel_test::make_robot(
      iksel_test::AxisMaker(dice).make(iksel_test::Pair::none, 0), dice, 3.0);
  const iksel::Solver any_solver(any);
  for (const std::string name : {"ur3", "irb120", "panda", "iiwa14", "cvr038", "anyhow"}) {
    const bool is_any = name == "anyhow";
    const iksel::Robot& robot = is_any ? any : iksel_test::robot(name);
    const iksel::Solver& solver = is_any ? any_solver : iksel_test::solver(name);
    std::vector<iksel::Pose> targets;
    std::vector<iksel::Pose> rotations = iksel_test::random_targets(robot, 600);
    for (std::size_t i = 0; i + 1 < rotations.size() && targets.size() < 20; ++i) {
      iksel::Pose target = rotations[i];
      target.linear() = rotations[i + 1].linear();
      if (!solver.solve(target).success()) targets.push_back(target);
    }
    ASSERT_GE(targets.size(), 5U) << name;
    iksel::SolveRequest closest;
    closest.closest.emplace();
    allocations = 0;
    watching = true;
    int proven = 0;
    for (const iksel::Pose& target : targets) {
      const iksel::Result result = solver.solve(target);
      proven += !result.success() && result.proof != iksel::Proof::none;
      (void)solver.solve(target, closest);
    }
    watching = false;
    EXPECT_EQ(allocations.load(), 0) << name;
    if (iksel::find_structure(robot).kind != iksel::StructureKind::searched) {
      EXPECT_GE(proven, 1) << name;
    }
  }
}

TEST(NoAllocation, GivenSeeds) {
  for (const bool paper : {false, true}) {
    const iksel::Robot& robot = iksel_test::robot("cvr038");
    iksel::SolverOptions options = paper ? iksel::SolverOptions::paper() : iksel::SolverOptions();
    options.database.scale = iksel::Scale::small;
    const iksel::Solver solver(robot, options);
    const Eigen::MatrixXd q = robot.random_configurations(3000, iksel_test::seed());
    const iksel::Pose target = robot.fk(q.row(0));
    for (const int seeds : {1, 100, 1024, 3000}) {
      for (const bool of_task : {false, true}) {
        iksel::SolveRequest request;
        for (int i = 0; i < seeds; ++i) request.seeds.push_back(q.row(i).transpose());
        if (of_task) request.task = iksel::Task::free_spin();
        // More than 1,024 need memory the first time.
        if (seeds > 1024) (void)solver.solve(target, request);
        allocations = 0;
        watching = true;
        (void)solver.solve(target, request);
        watching = false;
        EXPECT_EQ(allocations.load(), 0) << seeds << " seeds";
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, HeapFreeSchemes,
                         testing::Values(iksel::Iteration::dls, iksel::Iteration::pinv,
                                         iksel::Iteration::pinv_rr, iksel::Iteration::cwln,
                                         iksel::Iteration::cwpi, iksel::Iteration::lm));

}  // namespace

#else

TEST(NoAllocation, CannotBeWatchedHere) { GTEST_SKIP() << "needs glibc and no sanitizer"; }

#endif
