// SPDX-License-Identifier: BSD-3-Clause
// Laws of paths and trackers.
#include <gtest/gtest.h>

#include <cmath>
#include <iksel/iksel.hpp>
#include <stdexcept>

#include "base/random.hpp"
#include "robots.hpp"
#include "trees.hpp"

namespace {

using iksel::JointVector;
using iksel::PathOptions;
using iksel::PathResult;
using iksel::Pose;
using iksel::Result;
using iksel::Solver;
using iksel::Status;
using iksel_test::kTwoPi;

/// n poses from `first` along a straight line.
std::vector<Pose> line(const Pose& first, const Eigen::Vector3d& length, int n) {
  std::vector<Pose> poses;
  for (int i = 0; i < n; ++i) {
    Pose pose = first;
    pose.translation() += length * i / (n - 1);
    poses.push_back(pose);
  }
  return poses;
}

void expect_path(const Solver& solver, const std::vector<Pose>& poses, const PathOptions& options,
                 const PathResult& path) {
  ASSERT_TRUE(path.success()) << to_string(path.status) << " at " << path.first_unreachable;
  ASSERT_EQ(path.q.size(), poses.size());
  EXPECT_EQ(path.first_unreachable, -1);
  iksel_test::Judge judge(solver.robot());
  double largest = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    judge.expect_solution(poses[i], path.q[i]);
    if (i == 0 && !options.start) continue;
    const JointVector step = path.q[i] - (i == 0 ? *options.start : path.q[i - 1]);
    largest = std::max(largest, step.cwiseAbs().maxCoeff());
    if (options.dt == 0) continue;
    for (int j = 0; j < solver.robot().dof(); ++j) {
      EXPECT_LE(std::abs(step[j]), solver.robot().velocity_limit()[j] * options.dt * (1 + 1e-8));
    }
  }
  EXPECT_DOUBLE_EQ(path.largest_step, largest);
}

TEST(Path, StraightLineWithinTheVelocityLimits) {
  for (const char* name : {"panda", "cvr038"}) {
    const Solver& solver = iksel_test::solver(name);
    JointVector start = (solver.robot().lower() + solver.robot().upper()) / 2;
    if (std::string(name) == "cvr038") start[4] = 0.8;
    start[1] += 0.3;
    PathOptions options;
    options.start = start;
    options.dt = 0.02;
    const auto poses = line(solver.robot().fk(start), {0.0, 0.05, -0.05}, 60);
    expect_path(solver, poses, options, solver.solve_path(poses, options));
  }
}

TEST(Path, JointPathComesBackAndMovesNoMore) {
  // Poses of a joint path: a path through them exists, and the one found is no longer.
  for (const char* name : {"ur3", "irb14050"}) {
    const Solver& solver = iksel_test::solver(name);
    const auto& robot = solver.robot();
    const Eigen::MatrixXd ends = robot.random_configurations(2, iksel_test::seed());
    const JointVector from = ends.row(0).transpose();
    const JointVector to = ends.row(1).transpose();
    std::vector<Pose> poses;
    double length = 0;
    const int n = 80;
    for (int i = 0; i < n; ++i) poses.push_back(robot.fk(from + (to - from) * i / (n - 1.0)));
    length = (to - from).norm();
    PathOptions options;
    options.start = from;
    const PathResult path = solver.solve_path(poses, options);
    expect_path(solver, poses, options, path);
    EXPECT_LE(path.move, length * 1.001) << name << ", seed " << iksel_test::seed();
  }
}

TEST(Path, FirstWaypointWithoutContinuationIsNamed) {
  const Solver& solver = iksel_test::solver("ur3");
  const JointVector start = (JointVector(6) << 0.3, -1.2, 1.4, -0.6, 1.2, 0.2).finished();
  // Straight out of reach.
  const auto poses = line(solver.robot().fk(start), {0.6, 0.6, 0.0}, 100);
  PathOptions options;
  options.start = start;
  const PathResult path = solver.solve_path(poses, options);
  ASSERT_FALSE(path.success());
  ASSERT_GT(path.first_unreachable, 0);
  EXPECT_EQ(path.q.size(), static_cast<std::size_t>(path.first_unreachable));
  const auto broken = static_cast<std::size_t>(path.first_unreachable);
  EXPECT_TRUE(solver.solve(poses[broken - 1]).success());
  EXPECT_FALSE(solver.solve(poses[broken]).success());

  // Too fast: half a turn of the tool in one step.
  std::vector<Pose> flip = {poses[0], poses[0]};
  flip[1].linear() = flip[1].linear() * Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitZ());
  options.dt = 0.01;
  const PathResult fast = solver.solve_path(flip, options);
  EXPECT_EQ(fast.status, Status::too_fast);
  EXPECT_EQ(fast.first_unreachable, 1);
}

TEST(Path, WhatItGivesBeforeABreakIsMeasuredToo) {
  for (const char* name : {"ur3", "panda"}) {
    const Solver& solver = iksel_test::solver(name);
    iksel_test::Judge judge(solver.robot());
    const auto& robot = solver.robot();
    const Eigen::MatrixXd q = robot.random_configurations(20, iksel_test::seed());
    int broken = 0;
    for (int i = 0; i < 10; ++i) {
      PathOptions options;
      options.start = q.row(i).transpose();
      options.dt = 0.05;
      const auto poses = line(robot.fk(q.row(i)), {0.2, 0.3, 0.6}, 40);
      const PathResult path = solver.solve_path(poses, options);
      broken += !path.success();
      ASSERT_EQ(path.q.size(), path.success() ? poses.size() : std::size_t(path.first_unreachable));
      for (std::size_t w = 0; w < path.q.size(); ++w) {
        judge.expect_solution(poses[w], path.q[w]);
      }
    }
    EXPECT_GT(broken, 0);
  }
}

TEST(Path, FilterHoldsOnTheWholeWay) {
  const Solver& solver = iksel_test::solver("panda");
  const auto& robot = solver.robot();
  PathOptions options;
  options.start = (robot.lower() + robot.upper()) / 2;
  options.filter = iksel::filter_each(7, [](const JointVector& q) { return q[2] <= 0.01; });
  const auto poses = line(robot.fk(*options.start), {0.0, 0.1, -0.05}, 20);
  const PathResult path = solver.solve_path(poses, options);
  expect_path(solver, poses, options, path);
  for (const JointVector& q : path.q) EXPECT_LE(q[2], 0.01);
  options.filter = iksel::filter_each(7, [](const JointVector&) { return false; });
  const PathResult none = solver.solve_path(poses, options);
  EXPECT_EQ(none.status, Status::rejected);
  EXPECT_EQ(none.first_unreachable, 0);
  EXPECT_TRUE(none.q.empty());
}

TEST(Path, TellsItsProgressAndStopsOnAnException) {
  const Solver& solver = iksel_test::solver("ur3");
  const std::vector<Pose> poses(5, solver.robot().fk(JointVector::Constant(6, 0.5)));
  PathOptions options;
  std::vector<std::size_t> told;
  options.progress = [&](std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 5U);
    told.push_back(done);
  };
  EXPECT_TRUE(solver.solve_path(poses, options).success());
  EXPECT_EQ(told, (std::vector<std::size_t>{1, 2, 3, 4, 5}));
  options.progress = [](std::size_t done, std::size_t /*total*/) {
    if (done == 3) throw std::domain_error("enough");
  };
  EXPECT_THROW((void)solver.solve_path(poses, options), std::domain_error);
}

TEST(Path, BadInputIsNamed) {
  const Solver& solver = iksel_test::solver("ur3");
  std::vector<Pose> poses(3, solver.robot().fk(JointVector::Constant(6, 0.5)));
  const auto expect_error = [&](const PathOptions& options, const std::string& what) {
    try {
      (void)solver.solve_path(poses, options);
      FAIL() << what;
    } catch (const iksel::InvalidArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  PathOptions options;
  options.start = JointVector::Zero(5);
  expect_error(options, "start: expected 6 joint values, got 5");
  options = {};
  for (const double dt : {-1.0, double(NAN), double(INFINITY)}) {
    options.dt = dt;
    expect_error(options, "dt");
  }
  options = {};
  options.weights = JointVector::Constant(6, NAN);
  expect_error(options, "weights");
  options = {};
  options.candidates = 0;
  expect_error(options, "candidates: 0");
  options = {};
  poses[1].linear() *= 2;
  expect_error(options, "poses[1]");
  poses.clear();
  expect_error(options, "poses: there are none");
}

TEST(Path, BeginsAtTheTurnFromWhichItCanEnd) {
  // The last joint winds up by one and a half turns: of the copies that the first waypoint has,
  // only those low enough have room.
  const Solver& solver = iksel_test::solver("ur3");
  JointVector q = (JointVector(6) << 0.3, -1.2, 1.4, -0.6, 1.2, 1.0).finished();
  std::vector<Pose> poses;
  for (int i = 0; i <= 60; ++i) {
    poses.push_back(solver.robot().fk(q));
    q[5] += 1.5 * kTwoPi / 60;
  }
  PathOptions options;
  options.dt = 0.1;
  expect_path(solver, poses, options, solver.solve_path(poses, options));
}

TEST(Path, WhatIsKnownToGoInTimeAndWithoutAJumpDoes) {
  // Straight on in joint space, so that the poses can be followed; a redundant arm that goes its
  // own way may end at limits, and has to find another.
  constexpr int kWaypoints = 150;
  const int n = iksel_test::cases(20, 8);
  const iksel::Robot& panda = iksel_test::robot("panda");
  for (const iksel::Robot& robot : {panda, iksel_test::two_armed(panda)}) {
    const Solver solver(robot);
    const iksel::Matrix ends =
        robot.random_configurations(static_cast<std::size_t>(2 * n), iksel_test::seed());
    double move = 0;
    double known = 0;
    int failed = 0;
    for (int i = 0; i < n; ++i) {
      const JointVector from = ends.row(2 * i).transpose();
      const JointVector step = (JointVector(ends.row(2 * i + 1).transpose()) - from) / kWaypoints;
      std::vector<Pose> poses;
      for (int w = 1; w <= kWaypoints; ++w) {
        for (const Pose& pose : robot.tip_poses(from + w * step)) poses.push_back(pose);
      }
      for (const bool has_start : {false, true}) {
        for (const bool is_timed : {false, true}) {
          PathOptions options;
          if (has_start) options.start = from;
          if (is_timed)
            options.dt = 2 * (step.array().abs() / robot.velocity_limit().array()).maxCoeff();
          const PathResult path = solver.solve_path(poses, options);
          failed += !path.success() || path.largest_step > 0.3;
          if (!path.success()) continue;
          move += path.move;
          known += (kWaypoints - (has_start ? 0 : 1)) * step.norm();
        }
      }
    }
    EXPECT_LE(5 * failed, 4 * n) << robot.tips() << " tips, seed " << iksel_test::seed();
    EXPECT_LE(move, known) << robot.tips() << " tips, seed " << iksel_test::seed();
  }
}

TEST(Track, NeverFasterThanTheLimits) {
  for (const char* name : {"ur3", "panda"}) {
    const Solver& solver = iksel_test::solver(name);
    const auto& robot = solver.robot();
    const Eigen::MatrixXd ends = robot.random_configurations(10, iksel_test::seed());
    iksel::Tracker tracker(solver, ends.row(0).transpose());
    const double dt = 0.01;
    int arrived = 0;
    int late = 0;
    for (int i = 0; i < 1000; ++i) {
      const JointVector before = tracker.q();
      const Result result = tracker.track(robot.fk(ends.row(i / 100)), dt);
      for (int j = 0; j < robot.dof(); ++j) {
        EXPECT_LE(std::abs(tracker.q()[j] - before[j]),
                  robot.velocity_limit()[j] * dt * (1 + 1e-8));
      }
      EXPECT_TRUE(robot.within_limits(tracker.q()));
      if (result.success()) {
        EXPECT_EQ(result.q, tracker.q());
        ++arrived;
      }
      late += result.status == Status::too_fast;
    }
    EXPECT_GT(arrived, 0);
    EXPECT_GT(late, 0);
  }
}

TEST(Track, TheWayBackInsideIsAMoveThatKeepsToTheSpeed) {
  const double dt = 0.02;
  iksel::Random random(iksel_test::seed());
  for (const char* name : {"ur3", "panda", "cvr038"}) {
    const Solver& solver = iksel_test::solver(name);
    const auto& robot = solver.robot();
    const JointVector longest = robot.velocity_limit() * dt;
    const Eigen::MatrixXd q = robot.random_configurations(20, iksel_test::seed());
    for (int i = 0; i < q.rows(); ++i) {
      const JointVector inside = q.row(i).transpose();
      JointVector start = inside;
      const int j = static_cast<int>(random.uniform(0, robot.dof()));
      start[j] = random.uniform(0, 1) < 0.5 ? robot.lower()[j] - random.uniform(0.1, 1)
                                            : robot.upper()[j] + random.uniform(0.1, 1);
      iksel::Tracker tracker(solver, start);
      EXPECT_EQ(tracker.q(), start);
      const Pose target = robot.fk(start.cwiseMax(robot.lower()).cwiseMin(robot.upper()));
      Result result;
      for (int step = 0; step < 500 && !result.success(); ++step) {
        const JointVector before = tracker.q();
        result = tracker.track(target, dt);
        const JointVector move = tracker.q() - before;
        EXPECT_NEAR(result.move, move.norm(), 1e-12) << name << ", seed " << iksel_test::seed();
        EXPECT_TRUE((move.array().abs() <= longest.array() * (1 + 1e-8)).all())
            << name << ": " << start.transpose() << ", seed " << iksel_test::seed();
        EXPECT_EQ(result.status, result.success() ? Status::solved : Status::too_fast);
      }
      EXPECT_TRUE(result.success()) << name << ": " << start.transpose();
      EXPECT_TRUE(robot.within_limits(tracker.q()));
    }
  }
}

TEST(Track, CountsItsIterations) {
  const Solver& solver = iksel_test::solver("ur3");
  const auto& robot = solver.robot();
  const Eigen::MatrixXd q = robot.random_configurations(20, iksel_test::seed());
  for (int i = 0; i < q.rows(); ++i) {
    const JointVector start = q.row(i).transpose();
    iksel::Tracker tracker(solver, start);
    EXPECT_EQ(tracker.track(robot.fk(start), 1).iterations, 0);
    JointVector next = start;
    next[1] += start[1] > 0 ? -0.01 : 0.01;
    const Result moved = tracker.track(robot.fk(next), 1);
    EXPECT_GT(moved.iterations, 0) << to_string(moved.status) << ": " << start.transpose();
    Pose far = robot.fk(start);
    far.translation().x() += 5;
    EXPECT_GT(tracker.track(far, 1).iterations, 0);
  }
}

TEST(Track, StaysWhereThereIsNoContinuation) {
  const Solver& solver = iksel_test::solver("ur3");
  const JointVector start = (JointVector(6) << 0.3, -1.2, 1.4, -0.6, 1.2, 0.2).finished();
  iksel::Tracker tracker(solver, start);
  Pose far = solver.robot().fk(start);
  far.translation().x() += 5;
  const Result result = tracker.track(far, 0.01);
  EXPECT_FALSE(result.success());
  EXPECT_NE(result.status, Status::too_fast);
  EXPECT_EQ(tracker.q(), start);
}

TEST(Track, BadInputIsNamed) {
  const Solver& solver = iksel_test::solver("ur3");
  const JointVector start = JointVector::Constant(6, 0.5);
  const auto expect_error = [](const auto& call, const std::string& what) {
    try {
      call();
      FAIL() << what;
    } catch (const iksel::InvalidArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  expect_error([&] { iksel::Tracker(solver, JointVector::Zero(7)); }, "start");
  expect_error([&] { iksel::Tracker(solver, JointVector::Constant(6, NAN)); }, "start");
  iksel::Tracker tracker(solver, start);
  const Pose pose = solver.robot().fk(start);
  for (const double dt : {0.0, -0.1, double(NAN)}) {
    expect_error([&] { (void)tracker.track(pose, dt); }, "dt");
  }
  Pose bent = pose;
  bent.linear() *= 2;
  expect_error([&] { (void)tracker.track(bent, 0.01); }, "pose");
  EXPECT_EQ(tracker.q(), start);
  EXPECT_TRUE(tracker.track(pose, 0.01).success());
}

TEST(Track, FollowsAJointPathAtEveryStep) {
  const Solver& solver = iksel_test::solver("panda");
  const auto& robot = solver.robot();
  const JointVector start = (robot.lower() + robot.upper()) / 2;
  iksel::Tracker tracker(solver, start);
  for (int i = 1; i <= 500; ++i) {
    JointVector q = start;
    q[1] += 0.5 * std::sin(i * 0.01);
    q[3] += 0.4 * std::sin(i * 0.013);
    EXPECT_TRUE(tracker.track(robot.fk(q), 0.01).success()) << i;
  }
}

}  // namespace
