// SPDX-License-Identifier: BSD-3-Clause
// What solvers make of closed forms: all solutions, and proofs that there are none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>

#include "branches.hpp"
#include "closed_chains.hpp"
#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Proof;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel_test::Dice;

/// Where the arm can be, turned at random.
Pose turned_pose(const Robot& robot, const JointVector& q, Dice& dice) {
  Pose pose = robot.fk(q);
  pose.linear() = iksel_test::rotation_of_rpy<double>(dice.vector(3.1));
  return pose;
}

/// Whether q is near to one of the solutions.
bool is_among(const iksel::Solutions& solutions, const Robot& robot, const JointVector& q) {
  return std::any_of(solutions.all.begin(), solutions.all.end(), [&](const Result& result) {
    return iksel_test::distance(robot, result.q, q) < 0.02;
  });
}

/// From q, one with up to three joints at limits, the arm singular by another, both, or neither. Of
/// seven joints the elbow is straight, or the middle one of shoulder or wrist.
JointVector hard_one(const Robot& robot, JointVector q, Dice& dice) {
  if (robot.dof() == 7) {
    if (dice.chance(0.4))
      q[1 + 2 * dice.pick(3)] = dice.chance(0.5) ? 0 : dice.uniform(-1e-3, 1e-3);
  } else if (dice.chance(0.7)) {
    iksel_test::make_singular(robot, 1 + dice.pick(4), q);
  }
  for (int k = dice.pick(4); k > 0; --k) {
    const int j = dice.pick(robot.dof());
    q[j] = dice.chance(0.5) ? robot.lower()[j] : robot.upper()[j];
  }
  return q;
}

class Proofs : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] const Solver& solver() const { return iksel_test::solver(GetParam()); }
  [[nodiscard]] const Robot& robot() const { return solver().robot(); }
};
/// Of those whose solutions are points.
class ProofsOfSix : public Proofs {};

TEST_P(ProofsOfSix, AllSolutionsAreThoseOfManySeeds) {
  iksel_test::Judge judge(robot());
  const int n = iksel_test::cases(15);
  const Eigen::MatrixXd q = robot().random_configurations(n, iksel_test::seed());
  int proven = 0;
  int missed = 0;
  for (int i = 0; i < n; ++i) {
    const Pose target = robot().fk(q.row(i));
    const iksel::Solutions all = solver().solve_all(target);
    proven += all.proof == Proof::closed_form;
    for (const Result& result : all.all) judge.expect_solution(target, result.q);
    auto known = iksel_test::brute_force(solver(), target, 300);
    known.emplace_back(q.row(i));
    const bool is_missed = !std::all_of(known.begin(), known.end(), [&](const JointVector& other) {
      return is_among(all, robot(), other);
    });
    // Where the arm is singular up to the tolerances, there are solutions without end.
    missed += is_missed;
    EXPECT_FALSE(is_missed && all.proof == Proof::closed_form)
        << "pose " << i << ", seed " << iksel_test::seed();
  }
  EXPECT_LE(missed, 1 + n / 500);
  EXPECT_GE(proven, n * 9 / 10);
}

TEST_P(ProofsOfSix, SolutionsThatAreLeftOutAreNotDenied) {
  iksel::SolveAllOptions one;
  one.max = 1;
  int several = 0;
  const Eigen::MatrixXd q = robot().random_configurations(20, iksel_test::seed());
  for (int i = 0; i < q.rows(); ++i) {
    const Pose target = robot().fk(q.row(i));
    if (solver().solve_all(target).all.size() < 2) continue;
    ++several;
    EXPECT_EQ(solver().solve_all(target, one).proof, Proof::answer) << q.row(i);
  }
  EXPECT_GE(several, 5);
}

TEST_P(Proofs, NoOneElseSolvesWhatHasNoSolution) {
  iksel::SolverOptions options = iksel::SolverOptions::paper();
  iksel::Paper& paper = iksel_test::paper_of(options);
  paper.whole_turns = true;
  paper.candidates = 20;
  options.max_attempts = 1000;
  options.position_tolerance = options.rotation_tolerance = 1e-6;
  options.database.scale = iksel::Scale::small;
  const Solver other(robot(), options);
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(60, 30);
  const Eigen::MatrixXd q = robot().random_configurations(n, iksel_test::seed() + 1);
  std::vector<Pose> targets;
  for (int i = 0; i < n; ++i) targets.push_back(turned_pose(robot(), q.row(i), dice));
  const std::vector<Result> batch = solver().solve_batch(targets);
  int none = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Result result = solver().solve(targets[i]);
    EXPECT_EQ(result.status, batch[i].status);
    EXPECT_EQ(result.proof, batch[i].proof);
    if (robot().dof() == 6) EXPECT_EQ(result.q, batch[i].q);
    if (result.success()) continue;
    const bool is_proven = result.proof == Proof::closed_form;
    const Proof of_all = solver().solve_all(targets[i]).proof;
    EXPECT_EQ(of_all == Proof::closed_form, is_proven);
    if (robot().dof() == 6) EXPECT_EQ(of_all, result.proof);
    if (!is_proven || ++none > 10) continue;
    EXPECT_FALSE(other.solve(targets[i]).success()) << i << ", seed " << iksel_test::seed();
    EXPECT_TRUE(iksel_test::brute_force(solver(), targets[i], 200).empty()) << i;
  }
  EXPECT_GE(none, std::min(n / 10, 10));
}

/// Every other one is off by as much as the tolerances allow.
TEST_P(Proofs, WhatHasASolutionIsNeverSaidToHaveNone) {
  Dice dice(iksel_test::seed());
  const double tolerance = 0.99e-6;
  const int n = iksel_test::cases(400);
  const Eigen::MatrixXd random = robot().random_configurations(n, iksel_test::seed() + 2);
  std::vector<Pose> targets;
  std::vector<JointVector> made;
  for (int i = 0; i < n; ++i) {
    const JointVector q = hard_one(robot(), random.row(i), dice);
    const double off = i % 2 == 0 ? 0 : tolerance;
    targets.push_back(iksel_test::shifted(robot().fk(q), off, off, dice));
    made.push_back(q);
  }
  const std::vector<Result> batch = solver().solve_batch(targets);
  int solved = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Result result = solver().solve(targets[i]);
    solved += result.success();
    EXPECT_TRUE(result.success() || result.proof == Proof::none)
        << i << ", seed " << iksel_test::seed() << ": " << made[i].transpose();
    EXPECT_EQ(result.status, batch[i].status);
    if (robot().dof() == 6) EXPECT_EQ(result.q, batch[i].q);
    if (i % 2 == 0) {
      EXPECT_TRUE(result.success())
          << i << ", seed " << iksel_test::seed() << ": " << made[i].transpose();
    }
    const iksel::Solutions all = solver().solve_all(targets[i]);
    EXPECT_TRUE(all.success() || all.proof == Proof::none) << i << ": " << made[i].transpose();
  }
  EXPECT_GE(solved, n * 98 / 100);
}

TEST_P(ProofsOfSix, ACalibratedRobotHasNone) {
  const Solver calibrated(robot().with_tcp(Pose::Identity()), {}, solver().database(), robot());
  Dice dice(iksel_test::seed());
  const Eigen::MatrixXd q = robot().random_configurations(50, iksel_test::seed());
  for (int i = 0; i < q.rows(); ++i) {
    const Pose target = turned_pose(robot(), q.row(i), dice);
    EXPECT_NE(calibrated.solve(target).proof, Proof::closed_form);
    EXPECT_NE(calibrated.solve_all(target).proof, Proof::closed_form);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, ProofsOfSix, testing::Values("ur3", "irb120", "vs060", "ur5e"));
INSTANTIATE_TEST_SUITE_P(Robots, Proofs,
                         testing::Values("ur3", "irb120", "vs060", "ur5e", "iiwa7", "iiwa14",
                                         "valkyrie_right_arm"));

/// Solvers of random chains, whose limits cut into their branches.
TEST(ProofsOfRandomChains, HoldForEveryClass) {
  int proven = 0;
  int none = 0;
  int all = 0;
  iksel::SolverOptions options;
  options.database.samples = 300;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(iksel_test::cases(20, 10)); ++i) {
    const std::uint64_t seed = iksel_test::seed() * 1000 + i;
    SCOPED_TRACE("chain of seed " + std::to_string(seed));
    Dice dice(seed);
    const auto axes =
        iksel_test::AxisMaker(dice).make(iksel_test::kClosures[i % 5], i / 5 % 2 == 1);
    const Solver solver(iksel_test::make_robot(axes, dice, dice.uniform(1, 7)), options);
    const Robot& robot = solver.robot();
    const Eigen::MatrixXd q = robot.random_configurations(10, seed);
    for (int k = 0; k < q.rows(); ++k) {
      EXPECT_TRUE(solver.solve(robot.fk(q.row(k))).success()) << q.row(k);
      const Pose target = turned_pose(robot, q.row(k), dice);
      const iksel::Solutions solutions = solver.solve_all(target);
      const bool is_proven = solutions.proof == Proof::closed_form;
      ++all;
      proven += is_proven;
      none += is_proven && !solutions.success();
      for (const JointVector& other : iksel_test::brute_force(solver, target, 50)) {
        EXPECT_TRUE(!is_proven || is_among(solutions, robot, other)) << other.transpose();
      }
    }
  }
  EXPECT_GE(proven, all * 8 / 10);
  EXPECT_GE(none, all / 10);
}

TEST(ProofsOfOddOnes, TolerancesOfAnySizeAreAllowedFor) {
  Dice dice(iksel_test::seed());
  const Robot& robot = iksel_test::robot("irb120");
  for (const auto& [position, rotation] : {std::pair(1e-12, 1e-12),
                                           {1e-9, 1e-9},
                                           {1e-4, 1e-3},
                                           {1e-6, 1e-2},
                                           {1e-2, 1e-6},
                                           {0.1, 0.1}}) {
    iksel::SolverOptions options;
    options.position_tolerance = position;
    options.rotation_tolerance = rotation;
    const Solver solver(robot, options);
    const Eigen::MatrixXd random =
        robot.random_configurations(iksel_test::cases(100), iksel_test::seed());
    for (int i = 0; i < random.rows(); ++i) {
      const JointVector q = hard_one(robot, random.row(i), dice);
      EXPECT_TRUE(solver.solve(robot.fk(q)).success()) << position << ": " << q.transpose();
      const Pose target = iksel_test::shifted(robot.fk(q), 0.99 * position, 0.99 * rotation, dice);
      const Result result = solver.solve(target);
      EXPECT_TRUE(result.success() || result.proof == Proof::none)
          << position << ", " << rotation << ": " << q.transpose();
    }
  }
}

/// A UR3 whose tool is longer than the arm: the wrist moves by much where the tool turns by little.
TEST(ProofsOfOddOnes, LongTools) {
  Pose tool = Pose::Identity();
  tool.translation() = Eigen::Vector3d(5, 3, 20);
  iksel::SolverOptions options;
  options.rotation_tolerance = 1e-5;
  const Solver solver(iksel_test::robot("ur3").with_tcp(tool), options);
  const Robot& robot = solver.robot();
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(2000);
  const Eigen::MatrixXd random = robot.random_configurations(n, iksel_test::seed());
  for (int i = 0; i < n; ++i) {
    JointVector q = random.row(i);
    // Stretched, so that what is a little farther away has no branch.
    q[2] = 0;
    const Pose target = iksel_test::shifted(robot.fk(q), 0, 0.99e-5, dice);
    const Result result = solver.solve(target);
    EXPECT_TRUE(result.success() || result.proof == Proof::none) << i << ": " << q.transpose();
  }
}

/// Joints at limits that are more than a turn away from 0.
TEST(ProofsOfOddOnes, LimitsTurnsAway) {
  Dice dice(iksel_test::seed());
  iksel::SolverOptions options;
  options.database.samples = 300;
  for (const double from : {-15.0, -9.0, -4.0, 4.0, 9.0, 15.0}) {
    iksel_test::OddChain chain;
    const auto axes = iksel_test::AxisMaker(dice).make(iksel_test::Closure::parallel_23, false);
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 6; ++i) {
      iksel_test::OddJoint joint;
      joint.xyz = axes.p[i] - before;
      joint.axis = axes.h[i];
      joint.lower = from - 1;
      joint.upper = from + 1;
      before = axes.p[i];
      chain.joints.push_back(joint);
    }
    const Solver solver(
        Robot::from_urdf_string(iksel_test::urdf_of(chain), iksel_test::robot_options(chain)),
        options);
    const Robot& robot = solver.robot();
    const Eigen::MatrixXd random = robot.random_configurations(100, iksel_test::seed());
    for (int i = 0; i < random.rows(); ++i) {
      JointVector q = random.row(i);
      for (int j = 0; j < 6; ++j) {
        if (dice.chance(0.5)) q[j] = dice.chance(0.5) ? robot.lower()[j] : robot.upper()[j];
      }
      EXPECT_TRUE(solver.solve(robot.fk(q)).success()) << from << ": " << q.transpose();
    }
  }
}

}  // namespace
