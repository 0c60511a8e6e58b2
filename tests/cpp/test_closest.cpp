// SPDX-License-Identifier: BSD-3-Clause
// The configuration nearest to a target without an answer, beside brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "iksel/iksel.hpp"
#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::PoseWeights;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;
using iksel::Status;

/// By default a radian counts as a quarter of the reach, which is that of the whole chain stretched
/// out: told to both sides here.
PoseWeights weights_of(double rotation) {
  PoseWeights weights;
  weights.rotation = {rotation, rotation, rotation};
  return weights;
}

double remainder(const Robot& robot, const Pose& target, const JointVector& q, double rotation) {
  const auto e = iksel::pose_error(target, robot.fk(q));
  return std::hypot(e.head<3>().norm(), rotation * e.tail<3>().norm());
}

/// The least of a pattern search from `starts` configurations at random: slow, and knows nothing of
/// derivatives.
double search_by_pattern(const Robot& robot, const Pose& target, double rotation, int starts,
                         std::uint64_t seed) {
  const Eigen::MatrixXd q = robot.random_configurations(starts, seed);
  double least = 1e9;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    JointVector at = q.row(i);
    double value = remainder(robot, target, at, rotation);
    for (double step = 0.5; step > 1e-6;) {
      bool is_better = false;
      for (int j = 0; j < robot.dof(); ++j) {
        for (const double sign : {1.0, -1.0}) {
          JointVector next = at;
          next[j] = std::clamp(at[j] + sign * step, robot.lower()[j], robot.upper()[j]);
          const double there = remainder(robot, target, next, rotation);
          if (there >= value) continue;
          value = there;
          at = next;
          is_better = true;
        }
      }
      if (!is_better) step /= 2;
    }
    least = std::min(least, value);
  }
  return least;
}

/// Positions within reach with rotations of others: many have no answer.
Pose strange_pose(const Robot& robot, const Eigen::MatrixXd& q, int i) {
  Pose target = robot.fk(q.row(2 * i));
  target.linear() = robot.fk(q.row(2 * i + 1)).linear();
  target.translation() *= 1 + 0.3 * std::sin(i);
  return target;
}

TEST(Closest, ComesAsNearAsBruteForce) {
  for (const char* name : {"ur5e", "irb120", "cvr038", "panda", "xarm5"}) {
    const Robot& robot = iksel_test::robot(name);
    const Solver& solver = iksel_test::solver(name);
    constexpr double kRotation = 0.2;
    SolveRequest request;
    request.closest = weights_of(kRotation);
    const int cases = iksel_test::cases(30, 10);
    const Eigen::MatrixXd q = robot.random_configurations(2 * cases, iksel_test::seed());
    int compared = 0;
    int worse = 0;
    for (int i = 0; i < cases; ++i) {
      const Pose target = strange_pose(robot, q, i);
      const Result plain = solver.solve(target);
      const Result closest = solver.solve(target, request);
      EXPECT_EQ(plain.success(), closest.success());
      if (plain.success()) {
        EXPECT_EQ(plain.q, closest.q);
        continue;
      }
      ++compared;
      ASSERT_EQ(closest.status, Status::closest) << name << ", case " << i;
      EXPECT_EQ(closest.proof, plain.proof);
      EXPECT_TRUE(robot.within_limits(closest.q));
      const auto e = iksel::pose_error(target, robot.fk(closest.q));
      EXPECT_NEAR(closest.position_error, e.head<3>().norm(), 1e-9);
      EXPECT_NEAR(closest.rotation_error, e.tail<3>().norm(), 1e-9);
      const double brute = search_by_pattern(robot, target, kRotation, 60, iksel_test::seed() + i);
      worse += remainder(robot, target, closest.q, kRotation) > 1.01 * brute;
    }
    EXPECT_GT(compared, 0) << name;
    EXPECT_LE(worse, cases / 30) << name << ", of " << compared;
  }
}

TEST(Closest, WeighsPositionsAgainstRotations) {
  const Robot& robot = iksel_test::robot("ur5e");
  const Solver& solver = iksel_test::solver("ur5e");
  const Eigen::MatrixXd q = robot.random_configurations(200, iksel_test::seed());
  int compared = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose target = strange_pose(robot, q, i);
    SolveRequest request;
    request.closest = weights_of(0.01);
    const Result position = solver.solve(target, request);
    if (position.status != Status::closest) continue;
    request.closest = weights_of(10);
    const Result rotation = solver.solve(target, request);
    ++compared;
    EXPECT_LE(position.position_error, rotation.position_error + 1e-3) << "case " << i;
    EXPECT_GE(position.rotation_error, rotation.rotation_error - 1e-3) << "case " << i;
  }
  EXPECT_GT(compared, 10);
}

/// 300 descents from configurations at random beside the search, by weights of each axis.
TEST(Closest, CountsEachAxisByItsWeight) {
  PoseWeights weights;
  weights.position = {1, 0.2, 2};
  weights.rotation = {0.05, 0.3, 0.1};
  const auto missing = [&](const Robot& robot, const Pose& target, const JointVector& q) {
    const Pose back = target.inverse() * robot.fk(q);
    const Eigen::AngleAxisd turn(back.linear());
    double squares = 0;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      squares += std::pow(weights.position[k] * back.translation()[i], 2);
      squares += std::pow((*weights.rotation)[k] * turn.angle() * turn.axis()[i], 2);
    }
    return std::sqrt(squares);
  };
  for (const char* name : {"ur5e", "panda", "xarm5"}) {
    const Robot& robot = iksel_test::robot(name);
    const Solver& solver = iksel_test::solver(name);
    const int cases = iksel_test::cases(40, 10);
    const Eigen::MatrixXd q = robot.random_configurations(2 * cases, iksel_test::seed());
    const Eigen::MatrixXd starts = robot.random_configurations(300, iksel_test::seed() + 1);
    SolveRequest brute;
    brute.closest = weights;
    brute.database_seeds = false;
    for (Eigen::Index i = 0; i < starts.rows(); ++i) brute.seeds.push_back(starts.row(i));
    SolveRequest request;
    request.closest = weights;
    int worse = 0;
    int compared = 0;
    for (int i = 0; i < cases; ++i) {
      const Pose target = strange_pose(robot, q, i);
      const Result closest = solver.solve(target, request);
      if (closest.status != Status::closest) continue;
      const Result other = solver.solve(target, brute);
      ASSERT_EQ(other.status, Status::closest);
      ++compared;
      worse += missing(robot, target, closest.q) > 1.01 * missing(robot, target, other.q);
    }
    EXPECT_GT(compared, 3) << name;
    EXPECT_LE(20 * worse, compared + 10) << name << ": " << worse << " of " << compared;
  }
}

TEST(Closest, LiesOnTheSphereThatTheArmReaches) {
  // Far out along a ray, only the position counting: stretched out, on the way to the target.
  const Robot& robot = iksel_test::robot("panda");
  const Solver& solver = iksel_test::solver("panda");
  SolveRequest request;
  request.task = iksel::Task::position_only();
  request.closest = weights_of(0);
  Pose target = Pose::Identity();
  target.translation() << 1.5, 1.0, 0.6;
  const Result closest = solver.solve(target, request);
  ASSERT_EQ(closest.status, Status::closest);
  EXPECT_EQ(closest.proof, iksel::Proof::reach);
  EXPECT_EQ(closest.rotation_error, 0);
  EXPECT_NEAR(closest.position_error, search_by_pattern(robot, target, 0, 60, 1), 1e-4);
}

TEST(Closest, FollowsItsFilterAndItsSeeds) {
  const Robot& robot = iksel_test::robot("ur5e");
  const Solver& solver = iksel_test::solver("ur5e");
  Pose target = robot.fk(JointVector::Constant(6, 0.5));
  target.translation() *= 3;
  SolveRequest request;
  request.closest.emplace();
  const Result first = solver.solve(target, request);
  ASSERT_EQ(first.status, Status::closest);
  // Refused, another one that is not as near; and of all refused none.
  request.filter = iksel::filter_each(
      6, [&](const JointVector& q) { return (q - first.q).cwiseAbs().maxCoeff() > 1e-3; });
  const Result second = solver.solve(target, request);
  if (second.status == Status::closest) {
    EXPECT_GT((second.q - first.q).cwiseAbs().maxCoeff(), 1e-3);
  }
  request.filter = iksel::filter_each(6, [](const JointVector&) { return false; });
  EXPECT_NE(solver.solve(target, request).status, Status::closest);
  // In a batch the same rows.
  const std::vector<Result> rows = solver.solve_batch({target, target}, request);
  EXPECT_NE(rows[0].status, Status::closest);
  request.filter = nullptr;
  request.near = first.q;
  const Result near = solver.solve(target, request);
  EXPECT_NEAR(near.move, (near.q - first.q).norm(), 1e-12);
  EXPECT_LT(near.move, 1e-3);
}

TEST(Closest, FindsTheNearestOfTargetsThatAreAlmostReached) {
  // Of 2,000 targets of panda without an answer two that stopped 0.1 and 0.8 mm farther away than
  // 10,000 restarts come.
  const Robot& robot = iksel_test::robot("panda");
  const Solver& solver = iksel_test::solver("panda");
  struct Case {
    Eigen::Matrix<double, 3, 4> target;
    JointVector nearest;
  };
  std::vector<Case> cases(2, {{}, JointVector(7)});
  cases[0].target << -0.196809178221, 0.979342253371, -0.046420880315, -0.800848854438,
      -0.801666445529, -0.133484408768, 0.582677288667, 0.200144884647, 0.564444025109,
      0.151890300471, 0.811376780012, 0.406833085259;
  cases[0].nearest << -0.012386606, -1.7628, 0.725004169, -0.461695376, -0.106194287, 1.929585487,
      1.542085079;
  cases[1].target << 0.858065716088, -0.386923820814, -0.337658383225, 0.041307695437,
      -0.375568559883, -0.921246741775, 0.101255605258, -0.028812002685, -0.350244891044,
      0.039929909287, -0.935806667342, 0.966588425892;
  cases[1].nearest << 0.030673444, 0.46175635, -2.8973, -0.449700758, -0.261556983, 0.322885043,
      -2.731119735;
  SolveRequest request;
  request.closest.emplace();
  const double rotation = robot.reach() / 4;
  for (const Case& each : cases) {
    Pose target = Pose::Identity();
    target.matrix().topRows<3>() = each.target;
    const Result result = solver.solve(target, request);
    EXPECT_EQ(result.status, Status::closest);
    EXPECT_LE(remainder(robot, target, result.q, rotation),
              1.01 * remainder(robot, target, each.nearest, rotation));
  }
}

TEST(Closest, IsRefusedWhereItMakesNoSense) {
  const Solver& solver = iksel_test::solver("ur5e");
  SolveRequest request;
  request.closest.emplace();
  EXPECT_THROW(static_cast<void>(solver.solve_all(Pose::Identity(), {}, request)),
               iksel::InvalidArgumentError);
  request.closest->position = {0, 0, 0};
  request.closest->rotation = {0, 0, 0};
  EXPECT_THROW(static_cast<void>(solver.solve(Pose::Identity(), request)),
               iksel::InvalidArgumentError);
  request.closest->rotation = {1, -1, 0};
  EXPECT_THROW(static_cast<void>(solver.solve(Pose::Identity(), request)),
               iksel::InvalidArgumentError);
}

/// A target that leaves a reachable pose by 1 m and comes back, 1 mm a step.
struct Excursion {
  static constexpr double kStep = 1e-3;
  static constexpr double kDt = 0.01;
  Pose target;
  Eigen::Vector3d away;

  explicit Excursion(const Pose& pose)
      : target(pose), away(Eigen::Vector3d(pose.translation()).normalized()) {}
  void move(int step) { target.translation() += (step < 1000 ? kStep : -kStep) * away; }
};

TEST(Closest, TrackerGoesToTheBoundaryAndBack) {
  for (const char* name : {"ur5e", "panda", "iiwa14", "irb120", "xarm5"}) {
    const Robot& robot = iksel_test::robot(name);
    const Solver& solver = iksel_test::solver(name);
    const Eigen::MatrixXd q = robot.random_configurations(iksel_test::cases(20, 6), 3);
    const JointVector longest = robot.velocity_limit() * Excursion::kDt;
    Eigen::Index came_back = 0;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const JointVector start = 0.9 * JointVector(q.row(i));
      iksel::Tracker tracker(solver, robot.within_limits(start) ? start : JointVector(q.row(i)),
                             PoseWeights());
      Excursion excursion(robot.fk(tracker.q()));
      int outside = 0;
      // In the end it has time to get there.
      for (int step = 0; step < 2500; ++step) {
        if (step < 2000) excursion.move(step);
        const JointVector before = tracker.q();
        const Result result = tracker.track(excursion.target, Excursion::kDt);
        ASSERT_TRUE(result.success() || result.status == Status::closest ||
                    result.status == Status::too_fast);
        outside += result.status == Status::closest;
        EXPECT_TRUE(robot.within_limits(tracker.q()));
        EXPECT_LE(((tracker.q() - before).cwiseAbs() - longest).maxCoeff(), 1e-9);
        if (result.success()) EXPECT_EQ(tracker.q(), tracker.reached());
      }
      EXPECT_GT(outside, 0);
      came_back += remainder(robot, excursion.target, tracker.q(), 0.2) < 1e-5;
    }
    // Few stay behind a limit that they met outside.
    EXPECT_GE(10 * came_back, 8 * q.rows()) << name;
  }
}

TEST(Closest, TheToolIsAtMostThreeTimesAsFastAsTheTarget) {
  // Also where the nearest place vanishes, and the arm goes to another. Joints may be fast.
  constexpr double kRotation = 0.2;
  PoseWeights weights;
  weights.rotation = {kRotation, kRotation, kRotation};
  const auto way = [&](const Pose& a, const Pose& b) {
    const double turned = Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
    return std::hypot((a.translation() - b.translation()).norm(), kRotation * turned);
  };
  for (const char* name : {"ur5e", "panda", "xarm5"}) {
    const Robot& robot = iksel_test::robot(name);
    const Solver& solver = iksel_test::solver(name);
    const Eigen::MatrixXd q = robot.random_configurations(iksel_test::cases(20, 6), 7);
    int held_back = 0;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      for (const double dt : {Excursion::kDt, 1000.0}) {
        iksel::Tracker tracker(solver, q.row(i), weights);
        Excursion excursion(robot.fk(tracker.q()));
        Pose before = excursion.target;
        for (int step = 0; step < 2100; ++step) {
          if (step < 2000) excursion.move(step);
          const Status status = tracker.track(excursion.target, dt).status;
          const Pose now = robot.fk(tracker.q());
          ASSERT_LE(way(before, now), iksel::Tracker::kFastestTool * Excursion::kStep * (1 + 1e-9))
              << name << " " << i << ", step " << step;
          held_back += dt > 1 && status == Status::too_fast;
          before = now;
        }
      }
    }
    EXPECT_GT(held_back, 0) << name;
  }
}

TEST(Closest, WhatATaskLeavesFreeHoldsNoTrackerBack) {
  const Robot& robot = iksel_test::robot("ur5e");
  const Solver& solver = iksel_test::solver("ur5e");
  iksel::TargetCriteria criteria;
  criteria.task = iksel::Task::position_only();
  const Eigen::MatrixXd q = robot.random_configurations(iksel_test::cases(20, 6), 11);
  Eigen::Index alike = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    iksel::Tracker one(solver, q.row(i), PoseWeights(), criteria);
    iksel::Tracker other = one;
    Excursion excursion(robot.fk(one.q()));
    for (int step = 0; step < 500; ++step) {
      excursion.move(step);
      Pose turning = excursion.target;
      turning.rotate(Eigen::AngleAxisd(0.1 * step, Eigen::Vector3d::UnitZ()));
      static_cast<void>(one.track(excursion.target, Excursion::kDt));
      static_cast<void>(other.track(turning, Excursion::kDt));
    }
    alike += (one.q() - other.q()).norm() < 1e-6;
  }
  // At the edge rounding may choose the side.
  EXPECT_GE(10 * alike, 8 * q.rows());
}

TEST(Closest, WhatATaskLeavesFreeToOneSideIsAWayOfTheTarget) {
  iksel::TargetCriteria criteria;
  criteria.task.emplace().position_lower.fill(-iksel::kInfinity);
  const JointVector start = JointVector::Constant(6, 0.5);
  iksel::Tracker tracker(iksel_test::solver("ur5e"), start, PoseWeights(), criteria);
  Pose target = iksel_test::robot("ur5e").fk(start);
  target.translate(Eigen::Vector3d(-1e-3, 0, 0));
  static_cast<void>(tracker.track(target, Excursion::kDt));
  EXPECT_GT(tracker.state().speed, 0.05);
}

TEST(Closest, TrackerComesBackOnTheSideThatItLeft) {
  // Stretched out, an elbow may bend to both sides: it does to the one that it had before, whatever
  // side the arm has in the middle of its limits.
  const Robot& robot = iksel_test::robot("ur5e");
  const Solver& solver = iksel_test::solver("ur5e");
  for (const double elbow : {0.6, -0.6}) {
    JointVector start(6);
    start << 0.3, -0.8, elbow, -0.4, -1.2, 0.2;
    iksel::Tracker tracker(solver, start, PoseWeights());
    Excursion excursion(robot.fk(start));
    int edge = 0;
    for (int step = 0; step < 2100; ++step) {
      if (step < 2000) excursion.move(step);
      edge += tracker.track(excursion.target, Excursion::kDt).status == Status::closest;
    }
    EXPECT_GT(edge, 500);
    EXPECT_LT(remainder(robot, excursion.target, tracker.q(), 0.2), 1e-6);
    EXPECT_GT(tracker.q()[2] * elbow, 0) << elbow;
  }
}

}  // namespace
