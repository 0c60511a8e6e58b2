// SPDX-License-Identifier: BSD-3-Clause
// The solution that is nearest to given joint values, against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>

#include "branches.hpp"
#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;
using iksel_test::brute_force;
using iksel_test::noisy;
using iksel_test::shortest_move;

class NearOfSixJoints : public testing::TestWithParam<const char*> {};

TEST_P(NearOfSixJoints, NearestIsNearestOfBruteForce) {
  const Solver& solver = iksel_test::solver(GetParam());
  const Robot& robot = solver.robot();
  iksel_test::Judge judge(robot);
  const int n = iksel_test::cases(300, 30) / 15;
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
    judge.expect_solution(target, result.q);
    double best = shortest_move(robot, from, *request.near, request.norm);
    for (const JointVector& known : brute_force(solver, target, 1000)) {
      best = std::min(best, shortest_move(robot, known, *request.near, request.norm));
    }
    EXPECT_NEAR(result.move, shortest_move(robot, result.q, *request.near, request.norm), 1e-12);
    farther += result.move > best + 1e-3;
  }
  EXPECT_LE(farther, 1) << "of " << n << " poses, seed " << iksel_test::seed();
}

INSTANTIATE_TEST_SUITE_P(Robots, NearOfSixJoints, testing::Values("ur3", "cvr038", "cvrb1213"));

TEST(Near, IsTheAnswerWhereItReachesTheTarget) {
  for (const char* name : {"ur3", "cvr038", "panda", "iiwa14", "xarm7", "pr2_right_arm"}) {
    const Solver& solver = iksel_test::solver(name);
    const Robot& robot = solver.robot();
    const int n = iksel_test::cases(1000, 100);
    const Eigen::MatrixXd q = robot.random_configurations(n, iksel_test::seed());
    for (int i = 0; i < n; ++i) {
      SolveRequest request;
      request.near = JointVector(q.row(i).transpose());
      const Result result = solver.solve(robot.fk(*request.near), request);
      ASSERT_TRUE(result.success()) << name;
      EXPECT_LT(result.move, 1e-5) << name << ", row " << i << ", seed " << iksel_test::seed();
    }
  }
}

TEST(Near, MayLieOutsideTheLimits) {
  for (const char* name : {"panda", "ur3", "cvr038"}) {
    const Solver& solver = iksel_test::solver(name);
    const Robot& robot = solver.robot();
    iksel_test::Judge judge(robot);
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
      judge.expect_solution(target, result.q);
      // A UR's elbow is singular at its limit: within the tolerances it may be some mrad away.
      EXPECT_LE(result.move, 2e-2) << name << " joint " << joint;
    }
  }
}

TEST(Near, OfSevenJointsThatAreSearchedIsNoLongerThanFromAnySeed) {
  for (const char* name : {"baxter_right", "irb14050"}) {
    const Solver& solver = iksel_test::solver(name);
    const Robot& robot = solver.robot();
    const int n = iksel_test::cases(60);
    const Eigen::MatrixXd q = robot.random_configurations(n, iksel_test::seed());
    const Eigen::MatrixXd from = robot.random_configurations(n, iksel_test::seed() + 1);
    const Eigen::MatrixXd seeds = robot.random_configurations(100, iksel_test::seed() + 2);
    for (int i = 0; i < n; ++i) {
      SolveRequest request;
      request.near = JointVector(from.row(i).transpose());
      const Pose target = robot.fk(q.row(i));
      const double move = solver.solve(target, request).move;
      request.database_seeds = false;
      for (Eigen::Index k = 0; k < seeds.rows(); ++k) {
        request.seeds = {seeds.row(k).transpose()};
        const Result result = solver.solve(target, request);
        if (!result.success()) continue;
        ASSERT_LE(move, result.move + 0.01) << name << ", pose " << i;
      }
    }
  }
}

TEST(Near, RedundantArmHasSlidToALocalMinimum) {
  for (const char* name : {"panda", "iiwa14"}) {
    const Solver& solver = iksel_test::solver(name);
    const Robot& robot = solver.robot();
    iksel_test::Judge judge(robot);
    const int n = iksel_test::cases(300, 30) / 10;
    const Eigen::MatrixXd q = robot.random_configurations(n, iksel_test::seed());
    const iksel::Matrix noise = robot.random_configurations(n, iksel_test::seed() + 1);
    for (int i = 0; i < n; ++i) {
      SolveRequest request;
      request.near = noisy(q.row(i).transpose(), noise, i, 0.2);
      const Pose target = robot.fk(q.row(i));
      const Result result = solver.solve(target, request);
      ASSERT_TRUE(result.success());
      judge.expect_solution(target, result.q);
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

/// Between two samples of the swept joint the others turn by more than a radian here: past the
/// shoulder stretched out, beside where branches end. Bounds by single branches lost these.
TEST(Near, IsFoundWhereBranchesAreSteep) {
  const Solver& solver = iksel_test::solver("panda");
  const Robot& robot = solver.robot();
  const double cases[][2][7] = {
      {{2.3227, 0.1113, -0.1360, -0.3857, 2.4612, 0.6642, -1.9214},
       {2.4857, -0.4647, -0.2320, -0.4808, 2.2010, 0.3411, -2.1018}},
      {{1.8674, 0.0354, -1.0011, -2.0868, 1.5023, 1.0243, 2.2149},
       {1.9801, -0.2783, -0.9916, -2.6571, 1.3300, 0.5547, 2.1657}},
      {{0.0984, -0.0333, -1.7669, -0.6213, -1.2625, 2.5470, 1.3028},
       {-0.2220, 0.4006, -2.2255, -0.3369, -1.2370, 2.0658, 1.0999}},
      {{-1.0882, -0.0104, -1.7044, -1.9027, -1.3439, 1.7663, 0.7068},
       {-0.9913, 0.2445, -1.6638, -1.5704, -1.2622, 1.8505, 0.7200}},
      {{0.8883, 0.0477, -1.6227, -0.4934, 0.9436, 2.1595, -1.4735},
       {1.2287, -0.3224, -1.7526, -0.2452, 0.4982, 2.2084, -1.7079}},
      {{1.6427, -0.0997, 1.6617, -1.1325, 1.3686, 1.0765, 0.6203},
       {1.7772, 0.1858, 1.7409, -1.2638, 1.6870, 1.3638, 0.2721}},
  };
  for (const auto& [from, near] : cases) {
    SolveRequest request;
    request.near = Eigen::Map<const Eigen::VectorXd>(near, 7);
    const Pose target = robot.fk(Eigen::Map<const Eigen::VectorXd>(from, 7));
    double best = 10;
    for (const iksel::SelfMotionArc& arc : solver.self_motion(target, 0.01).arcs) {
      for (const JointVector& q : arc.q) {
        best = std::min(best, shortest_move(robot, q, *request.near, request.norm));
      }
    }
    EXPECT_LE(solver.solve(target, request).move, best + 1e-6) << best;
  }
}

/// Whatever `near` is, and wherever the target lies.
TEST(Near, WhatCanBeReachedIsFound) {
  for (const char* name : {"panda", "iiwa14", "xarm7", "pr2_right_arm"}) {
    const Solver& solver = iksel_test::solver(name);
    const Robot& robot = solver.robot();
    iksel_test::Judge judge(robot);
    const int n = iksel_test::cases(2000, 200);
    Eigen::MatrixXd q = robot.random_configurations(n, iksel_test::seed());
    const Eigen::MatrixXd near = robot.random_configurations(n, iksel_test::seed() + 1);
    constexpr int kElbow = 3;
    for (int i = 0; i < n; ++i) {
      // Half of the arms have their elbow all but at a limit, where some are all but straight.
      if (i % 2 == 0) {
        const bool at_upper = i % 4 == 0;
        q(i, kElbow) = at_upper ? robot.upper()[kElbow] - 1e-4 * (i % 300)
                                : robot.lower()[kElbow] + 1e-4 * (i % 300);
      }
      SolveRequest request;
      request.near = JointVector(near.row(i).transpose());
      const Pose target = robot.fk(q.row(i));
      const Result result = solver.solve(target, request);
      ASSERT_TRUE(result.success()) << name << ", row " << i << ", seed " << iksel_test::seed();
      judge.expect_solution(target, result.q);
    }
  }
}

/// With the arm all but straight a joint of its shoulder may be anywhere at the samples of the
/// swept joint where there is no branch: limits say nothing there. These were called unreachable.
TEST(Near, LimitsSayNothingOfAStraightArmsShoulder) {
  const Solver& solver = iksel_test::solver("pr2_right_arm");
  const Robot& robot = solver.robot();
  const double cases[][2][7] = {
      {{-2.1079, 0.2514, -2.7175, -0.0149, 1.1138, -1.3789, 2.2881},
       {-0.4510, -0.4875, -0.2632, -0.7493, -2.9297, -0.6738, 1.0512}},
      {{-1.4462, -0.4315, -0.1944, -0.0147, 2.7896, -0.7510, 1.0451},
       {0.0920, -0.4468, -0.2420, -0.6754, -0.5476, -0.4585, 2.4002}},
      {{-0.5261, -0.2548, 0.6602, -0.0108, -1.2607, -1.6369, 0.7608},
       {-0.6633, 1.2571, -1.2147, -1.1334, 1.3258, -1.4439, 0.4858}},
      {{0.5618, -0.1449, -0.2288, -0.0122, -2.8312, -0.5458, 2.6631},
       {-0.7397, -0.5107, -2.4598, -0.5609, 0.2939, -0.3937, 1.6051}},
  };
  for (const auto& [from, near] : cases) {
    SolveRequest request;
    request.near = Eigen::Map<const Eigen::VectorXd>(near, 7);
    const Pose target = robot.fk(Eigen::Map<const Eigen::VectorXd>(from, 7));
    EXPECT_TRUE(solver.solve(target, request).success());
  }
}

/// Branches that have merged come as near to an answer as each other, and took the place of others:
/// a sweep that followed sixteen called this unreachable.
TEST(Near, IsFoundBesideManyBranchesThatComeAsNear) {
  const Solver& solver = iksel_test::solver("panda");
  JointVector from(7), near(7);
  from << 0.9507, 1.7413, -0.6108, -0.4093, -1.5708, 0.0366, 0.6255;
  near << 1.0353, -1.6276, 2.2915, -2.3258, 0.7238, 3.7169, -1.9519;
  SolveRequest request;
  request.near = near;
  EXPECT_TRUE(solver.solve(solver.robot().fk(from), request).success());
}

/// The nearest lies between samples that are up to 1.5 rad farther away than another answer: all
/// that is within 2.5 rad is looked at.
TEST(Near, IsFoundBetweenSamplesThatLieFartherAway) {
  struct Case {
    const char* name;
    double answer[7], near[7];
  };
  const Case cases[] = {
      {"panda",
       {-2.4014, 0.0135, -0.6478, -0.5766, 2.4376, 1.6078, -0.3849},
       {-2.5928, -0.0945, -0.8427, -0.2109, 2.1891, 1.3821, -0.4415}},
      {"panda",
       {-1.4633, 0.0022, -2.7617, -0.3003, -1.8518, 0.8644, 2.1353},
       {-1.6009, -0.0828, -2.8973, -0.5002, -2.1427, 1.1943, 2.2048}},
      {"iiwa14",
       {-1.9956, -1.1928, -0.1368, 0.0779, 1.9744, -0.0022, -0.2146},
       {-2.3301, -1.2981, -0.1590, -0.0122, 2.3776, 0.2929, 0.1319}},
      {"iiwa14",
       {-0.7433, 1.7787, 2.2760, -0.2068, 2.5952, 0.0244, 1.3351},
       {-0.4289, 1.2504, 2.1684, 0.2792, 2.4824, -0.2630, 1.2224}},
      {"iiwa14",
       {-0.6545, 0.8457, -2.8842, 0.0689, -2.6095, -1.9505, 0.8067},
       {-0.6976, 1.1045, -2.9671, 0.1360, -2.6949, -2.0944, 1.0487}},
  };
  for (const auto& [name, answer, near] : cases) {
    const Solver& solver = iksel_test::solver(name);
    const JointVector known = Eigen::Map<const Eigen::VectorXd>(answer, 7);
    SolveRequest request;
    request.near = Eigen::Map<const Eigen::VectorXd>(near, 7);
    const Result result = solver.solve(solver.robot().fk(known), request);
    EXPECT_LE(result.move, (known - *request.near).norm() + 1e-6) << name;
  }
}

}  // namespace
