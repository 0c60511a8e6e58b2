// SPDX-License-Identifier: BSD-3-Clause
// What one tip can, several can: solve_all, objectives, what is closest, scenes, paths, the
// tracker, goals in the frame of another tip; judged by KDL's kinematics of each chain, and by
// brute force.
#include <gtest/gtest.h>

#include <cmath>
#include <iksel/iksel.hpp>

#include "robots.hpp"
#include "trees.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;
using iksel::Status;
using iksel_test::two_armed;

JointVector joints_in(const iksel::Matrix& q, int i) { return q.row(i).transpose(); }

const Solver& two_pandas() {
  static const Solver solver(two_armed(iksel_test::robot("panda")));
  return solver;
}

/// By the chains' KDL kinematics; the other tip's pose where a target is in its frame.
double worst_error(const Robot& robot, const std::vector<Pose>& targets, const JointVector& q,
                   const std::vector<int>& in_frame_of = {}) {
  std::vector<Pose> reached;
  for (int i = 0; i < robot.tips(); ++i) {
    JointVector of_chain(robot.chain(i).dof());
    for (int j = 0; j < of_chain.size(); ++j) {
      of_chain[j] = q[robot.joints_of(i)[static_cast<std::size_t>(j)]];
    }
    reached.push_back(robot.chain(i).fk(of_chain, iksel::Kinematics::kdl));
  }
  double worst = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const int frame = in_frame_of.empty() ? -1 : in_frame_of[i];
    const Pose seen =
        frame < 0 ? reached[i] : reached[static_cast<std::size_t>(frame)].inverse() * reached[i];
    const auto error = iksel::pose_error(targets[i], seen);
    worst = std::max({worst, error.head<3>().norm(), error.tail<3>().norm()});
  }
  return worst;
}

TEST(TipsLaws, AllSolutionsAreSolutionsApart) {
  const Solver& solver = two_pandas();
  const iksel::Matrix q = solver.robot().random_configurations(20, iksel_test::seed());
  iksel::SolveAllOptions all;
  all.max = 16;
  all.min_distance = 0.05;
  for (int i = 0; i < q.rows(); ++i) {
    const std::vector<Pose> targets = solver.robot().tip_poses(joints_in(q, i));
    const iksel::Solutions solutions = solver.solve_all(targets, all);
    EXPECT_GE(solutions.all.size(), 8U) << "target " << i << ", seed " << iksel_test::seed();
    for (std::size_t a = 0; a < solutions.all.size(); ++a) {
      EXPECT_LE(worst_error(solver.robot(), targets, solutions.all[a].q), 1.001e-6);
      EXPECT_TRUE(solver.robot().within_limits(solutions.all[a].q));
      for (std::size_t b = 0; b < a; ++b) {
        const JointVector d = solutions.all[a].q - solutions.all[b].q;
        EXPECT_GE(d.cwiseAbs().maxCoeff(), 0.05 - 1e-9);
      }
    }
  }
}

TEST(TipsLaws, AnObjectiveIsNoWorseThanWhatIsKnown) {
  const Solver& solver = two_pandas();
  const int n = iksel_test::cases(30, 10);
  const iksel::Matrix q =
      solver.robot().random_configurations(static_cast<std::size_t>(n), iksel_test::seed());
  int worse = 0;
  for (int i = 0; i < n; ++i) {
    SolveRequest request;
    request.objective = iksel::Objective::far_from_limits();
    const std::vector<Pose> targets = solver.robot().tip_poses(joints_in(q, i));
    const Result best = solver.solve(targets, request);
    ASSERT_TRUE(best.success());
    EXPECT_LE(worst_error(solver.robot(), targets, best.q), 1.001e-6);
    const Result any = solver.solve(targets);
    SolveRequest of_any = request;
    of_any.seeds = {any.q};
    of_any.database_seeds = false;
    const Result known = solver.solve(targets, of_any);
    worse += known.success() && best.cost > known.cost + 1e-6;
  }
  EXPECT_LE(worse, n / 10) << "of " << n << ", seed " << iksel_test::seed();
}

TEST(TipsLaws, WhatIsClosestIsNoFartherThanSamples) {
  const Solver& solver = two_pandas();
  const Robot& robot = solver.robot();
  const int n = iksel_test::cases(10, 4);
  const iksel::Matrix q =
      robot.random_configurations(static_cast<std::size_t>(n), iksel_test::seed());
  const iksel::Matrix other = robot.random_configurations(2000, iksel_test::seed() + 1);
  for (int i = 0; i < n; ++i) {
    SolveRequest request;
    request.closest.emplace();
    request.closest->rotation = {0.3, 0.3, 0.3};
    std::vector<Pose> targets = robot.tip_poses(joints_in(q, i));
    targets[0].translation() += Eigen::Vector3d(0, 3, 0);
    const Result closest = solver.solve(targets, request);
    ASSERT_EQ(closest.status, Status::closest);
    EXPECT_TRUE(robot.within_limits(closest.q));
    const auto left = [&](const JointVector& at) {
      double sum = 0;
      const std::vector<Pose> poses = robot.tip_poses(at);
      for (std::size_t tip = 0; tip < poses.size(); ++tip) {
        const auto e = iksel::pose_error(targets[tip], poses[tip]);
        sum += e.head<3>().squaredNorm() + 0.09 * e.tail<3>().squaredNorm();
      }
      return sum;
    };
    const double reached = left(closest.q);
    for (int k = 0; k < other.rows(); ++k) ASSERT_LE(reached, left(joints_in(other, k)));
  }
}

/// A ball around each of the arms' links, and one arm held against the other.
iksel::RobotSpheres balls_of(const Robot& robot, double radius) {
  iksel::RobotSpheres spheres;
  std::vector<std::string> sides[2];
  for (const std::string& link : robot.link_names()) {
    if (link.compare(0, 2, "l_") != 0 && link.compare(0, 2, "r_") != 0) continue;
    spheres.links[link] = {iksel::Sphere{Eigen::Vector3d::Zero(), radius}};
    sides[link[0] == 'r'].push_back(link);
  }
  for (const std::string& left : sides[0]) {
    for (const std::string& right : sides[1]) spheres.pairs.emplace_back(left, right);
  }
  return spheres;
}

TEST(TipsLaws, AnswersInASceneAreFreeOfIt) {
  const Solver& solver = two_pandas();
  const Robot& robot = solver.robot();
  iksel::Scene scene(robot, balls_of(robot, 0.08));
  Pose T = Pose::Identity();
  T.translation() << 0.5, 0, 0.4;
  scene.set("box", iksel::Obstacle::box({0.2, 0.2, 0.4}, T));
  const int n = iksel_test::cases(200, 40);
  const iksel::Matrix q =
      robot.random_configurations(static_cast<std::size_t>(n), iksel_test::seed());
  int free = 0;
  int lost = 0;
  for (int i = 0; i < n; ++i) {
    if (!scene.is_free(joints_in(q, i))) continue;
    ++free;
    SolveRequest request;
    request.scene = scene;
    const std::vector<Pose> targets = robot.tip_poses(joints_in(q, i));
    const Result result = solver.solve(targets, request);
    lost += result.success() ? 0 : 1;
    if (!result.success()) continue;
    EXPECT_TRUE(scene.is_free(result.q));
    EXPECT_LE(worst_error(robot, targets, result.q), 1.001e-6);
    request.near = joints_in(q, i);
    const Result nearest = solver.solve(targets, request);
    ASSERT_TRUE(nearest.success());
    EXPECT_LE(nearest.move, 1e-6);
  }
  EXPECT_GT(free, n / 20);
  EXPECT_LE(lost, free / 100) << "of " << free << ", seed " << iksel_test::seed();
}

TEST(TipsLaws, ATargetMayBeInTheFrameOfAnotherTip) {
  const Solver& solver = two_pandas();
  const Robot& robot = solver.robot();
  const int n = iksel_test::cases(100, 30);
  const iksel::Matrix q =
      robot.random_configurations(static_cast<std::size_t>(n), iksel_test::seed());
  for (const bool is_free : {false, true}) {
    int lost = 0;
    for (int i = 0; i < n; ++i) {
      std::vector<Pose> targets = robot.tip_poses(joints_in(q, i));
      targets[1] = targets[0].inverse() * targets[1];
      SolveRequest request;
      request.in_frame_of = {-1, 0};
      // The first hand may turn as it likes.
      if (is_free) request.tasks = {iksel::Task::position_only(), iksel::Task::pose()};
      const Result result = solver.solve(targets, request);
      lost += result.success() ? 0 : 1;
      if (!result.success()) continue;
      if (is_free) {
        EXPECT_LE((robot.tip_poses(result.q)[0].translation() - targets[0].translation()).norm(),
                  1.001e-6);
      } else {
        EXPECT_LE(worst_error(robot, targets, result.q, request.in_frame_of), 1.001e-6);
      }
      request.near = joints_in(q, i);
      const Result nearest = solver.solve(targets, request);
      ASSERT_TRUE(nearest.success());
      EXPECT_LE(nearest.move, 1e-6);
    }
    EXPECT_LE(lost, n / 50) << "of " << n << ", seed " << iksel_test::seed();
  }
  SolveRequest circle;
  circle.in_frame_of = {1, 0};
  const std::vector<Pose> two(2, Pose::Identity());
  EXPECT_THROW(static_cast<void>(solver.solve(two, circle)), iksel::InvalidArgumentError);
}

TEST(TipsLaws, APathKeepsWhatTheHandsCarry) {
  const Solver& solver = two_pandas();
  const Robot& robot = solver.robot();
  constexpr int kWaypoints = 40;
  const JointVector start = joints_in(robot.random_configurations(1, iksel_test::seed()), 0);
  // A box between the hands: the right one is where it is seen from the left.
  const std::vector<Pose> first = robot.tip_poses(start);
  std::vector<Pose> waypoints;
  for (int w = 0; w < kWaypoints; ++w) {
    Pose left = first[0];
    left.translation() += Eigen::Vector3d(0, 0, 0.05 * std::sin(0.1 * w));
    waypoints.push_back(left);
    waypoints.emplace_back(first[0].inverse() * first[1]);
  }
  iksel::PathOptions options;
  options.start = start;
  options.in_frame_of = {-1, 0};
  const iksel::PathResult path = solver.solve_path(waypoints, options);
  ASSERT_TRUE(path.success()) << path.first_unreachable << ", seed " << iksel_test::seed();
  ASSERT_EQ(path.q.size(), kWaypoints);
  for (std::size_t w = 0; w < kWaypoints; ++w) {
    const std::vector<Pose> targets(waypoints.begin() + static_cast<std::ptrdiff_t>(2 * w),
                                    waypoints.begin() + static_cast<std::ptrdiff_t>(2 * w + 2));
    EXPECT_LE(worst_error(robot, targets, path.q[w], options.in_frame_of), 1.001e-6);
  }
  EXPECT_LE(path.largest_step, 0.2);
}

TEST(TipsLaws, TheTrackerFollowsBothHands) {
  const Solver& solver = two_pandas();
  const Robot& robot = solver.robot();
  const JointVector start = 0.9 * joints_in(robot.random_configurations(1, 7), 0);
  const JointVector inside = start.cwiseMax(robot.lower()).cwiseMin(robot.upper());
  iksel::Tracker tracker(solver, inside);
  const std::vector<Pose> first = robot.tip_poses(inside);
  int reached = 0;
  for (int step = 0; step < 100; ++step) {
    std::vector<Pose> targets = first;
    targets[0].translation().z() += 2e-4 * step;
    targets[1].translation().z() += 2e-4 * step;
    const Result result = tracker.track(targets, 0.01);
    if (!result.success()) continue;
    ++reached;
    EXPECT_LE(worst_error(robot, targets, tracker.q()), 1.001e-6);
  }
  EXPECT_GE(reached, 90);
}

TEST(TipsLaws, TheTrackerHoldsWhatTheHandsCarry) {
  const Solver& solver = two_pandas();
  const Robot& robot = solver.robot();
  iksel::TargetCriteria criteria;
  criteria.in_frame_of = {-1, 0};
  const int n = iksel_test::cases(20, 6);
  const iksel::Matrix q =
      robot.random_configurations(static_cast<std::size_t>(n), iksel_test::seed());
  int reached = 0;
  for (int i = 0; i < n; ++i) {
    for (const bool has_closest : {false, true}) {
      std::optional<iksel::PoseWeights> closest;
      if (has_closest) closest.emplace();
      iksel::Tracker tracker(solver, joints_in(q, i), closest, criteria);
      std::vector<Pose> targets = robot.tip_poses(joints_in(q, i));
      targets[1] = targets[0].inverse() * targets[1];
      for (int step = 0; step < 50; ++step) {
        targets[0].translation().z() += 2e-4;
        targets[0].rotate(Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitX()));
        if (!tracker.track(targets, 0.01).success()) continue;
        ++reached;
        EXPECT_LE(worst_error(robot, targets, tracker.q(), criteria.in_frame_of), 1.001e-6);
      }
    }
  }
  // Some meet limits.
  EXPECT_GE(reached, 70 * n) << "of " << 100 * n << ", seed " << iksel_test::seed();
}

TEST(TipsLaws, TheTrackerFollowsATaskOfEachTip) {
  const Solver& solver = two_pandas();
  const Robot& robot = solver.robot();
  const JointVector start = joints_in(robot.random_configurations(1, 7), 0);
  std::vector<Pose> targets = robot.tip_poses(start);
  iksel::TargetCriteria criteria;
  criteria.tasks = {iksel::Task::position_only(), iksel::Task::pose()};
  iksel::Tracker tracker(solver, start, std::nullopt, criteria);
  // What is free is looked at nowhere.
  targets[0].linear() = Eigen::Matrix3d::Identity();
  int reached = 0;
  for (int step = 0; step < 100; ++step) {
    for (Pose& target : targets) target.translation().z() += 2e-4;
    if (!tracker.track(targets, 0.01).success()) continue;
    ++reached;
    const std::vector<Pose> now = robot.tip_poses(tracker.q());
    EXPECT_LE((now[0].translation() - targets[0].translation()).norm(), 1.001e-6);
    EXPECT_LE(iksel::pose_error(targets[1], now[1]).norm(), 1.5e-6);
  }
  EXPECT_GE(reached, 90);
}

TEST(TipsLaws, ATrackerRefusesCriteriaThatDoNotFit) {
  const Solver& solver = two_pandas();
  const JointVector start = solver.robot().random_configurations(1, 7).row(0).transpose();
  const auto expect_named = [&](const iksel::TargetCriteria& criteria, const std::string& name) {
    try {
      const iksel::Tracker tracker(solver, start, std::nullopt, criteria);
      FAIL() << name;
    } catch (const iksel::InvalidArgumentError& error) {
      EXPECT_EQ(std::string(error.what()).find(name), 0U) << error.what();
    }
  };
  iksel::Task bad;
  bad.position_lower[0] = 1;
  expect_named({{}, {iksel::Task::pose()}, {}}, "tasks");
  expect_named({{}, std::vector<iksel::Task>(3), {}}, "tasks");
  expect_named({{}, {}, {-1}}, "in_frame_of");
  expect_named({{}, {}, {-1, 2}}, "in_frame_of[1]");
  expect_named({{}, {}, {1, 0}}, "in_frame_of[0]");
  EXPECT_THROW(iksel::Tracker(solver, start, std::nullopt, {bad, {}, {}}),
               iksel::InvalidArgumentError);
}

TEST(TipsLaws, WhatIsAboutOneTipRefusesSeveral) {
  const Solver& solver = two_pandas();
  const Robot& robot = solver.robot();
  const JointVector q = JointVector::Zero(robot.dof());
  EXPECT_THROW(static_cast<void>(robot.fk(q)), iksel::InvalidArgumentError);
  EXPECT_THROW(static_cast<void>(robot.tip_link()), iksel::InvalidArgumentError);
  EXPECT_THROW(static_cast<void>(solver.solve(Pose::Identity())), iksel::InvalidArgumentError);
  EXPECT_THROW(static_cast<void>(solver.database()), iksel::InvalidArgumentError);
  EXPECT_THROW(static_cast<void>(solver.self_motion(Pose::Identity())),
               iksel::InvalidArgumentError);
  EXPECT_THROW(static_cast<void>(iksel::Database::build(robot)), iksel::InvalidArgumentError);
  EXPECT_THROW(static_cast<void>(solver.solve_path({Pose::Identity()}, {})),
               iksel::InvalidArgumentError);
}

TEST(TipsLaws, OneTipIsTheChain) {
  const Robot& arm = iksel_test::robot("panda");
  const Solver one(Robot::from_urdf_string(arm.urdf(), iksel_test::tips_of({arm.tip_link()})));
  const Solver chain(arm);
  const iksel::Matrix q = arm.random_configurations(100, iksel_test::seed());
  for (int i = 0; i < q.rows(); ++i) {
    const Pose target = arm.fk(joints_in(q, i));
    EXPECT_EQ(one.solve({target}).q, chain.solve(target).q);
  }
}

}  // namespace
