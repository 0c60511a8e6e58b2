// SPDX-License-Identifier: BSD-3-Clause
// Arms of six joints of which one is swept: what is concluded from the roots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <vector>

#include "branches.hpp"
#include "closed_chains.hpp"
#include "robots.hpp"
#include "seeds/beyond_limits.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Proof;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel_test::Dice;

class RootSweeps : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] const Solver& solver() const { return iksel_test::solver(GetParam()); }
  [[nodiscard]] const Robot& robot() const { return solver().robot(); }
};

TEST_P(RootSweeps, SolutionsAreThoseOfManySeeds) {
  iksel_test::Judge judge(robot());
  const int n = iksel_test::cases(15);
  const Eigen::MatrixXd random = robot().random_configurations(n, iksel_test::seed());
  int concluded = 0;
  int missed = 0;
  for (int i = 0; i < n; ++i) {
    const Pose target = robot().fk(random.row(i));
    const iksel::Solutions all = solver().solve_all(target);
    concluded += all.proof == Proof::sweep;
    for (const Result& result : all.all) judge.expect_solution(target, result.q);
    auto known = iksel_test::brute_force(solver(), target, 300);
    known.emplace_back(random.row(i));
    for (const JointVector& q : known) {
      if (iksel_test::least_singular_value(robot().jacobian(q)) < 1e-3) continue;
      missed += std::none_of(all.all.begin(), all.all.end(), [&](const Result& result) {
        return iksel_test::distance(robot(), result.q, q) < 0.02;
      });
    }
  }
  EXPECT_LE(missed, n / 500) << "seed " << iksel_test::seed();
  EXPECT_GE(concluded, n * 9 / 10);
}

/// Solutions at limits, and where two of them meet.
TEST_P(RootSweeps, WhatIsReachableIsNotSaidToHaveNoSolution) {
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(300);
  const Eigen::MatrixXd random = robot().random_configurations(n, iksel_test::seed() + 3);
  int unsolved = 0;
  for (int i = 0; i < n; ++i) {
    JointVector q = random.row(i);
    for (int k = dice.pick(4); k > 0; --k) {
      const int j = dice.pick(6);
      const double limit = dice.chance(0.5) ? robot().lower()[j] : robot().upper()[j];
      if (std::isfinite(limit)) q[j] = limit;
    }
    if (dice.chance(0.5)) iksel_test::make_singular(robot(), 1 + dice.pick(4), q);
    const Result result = solver().solve(robot().fk(q));
    unsolved += !result.success();
    EXPECT_TRUE(result.success() || result.proof == Proof::none)
        << q.transpose() << ", seed " << iksel_test::seed();
  }
  EXPECT_LE(unsolved, n / 100);
}

TEST_P(RootSweeps, NoOneElseSolvesWhatHasNone) {
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(60, 20);
  const Eigen::MatrixXd random = robot().random_configurations(n, iksel_test::seed());
  int none = 0;
  for (int i = 0; i < n; ++i) {
    Pose target = robot().fk(random.row(i));
    target.linear() = iksel_test::rotation_of_rpy<double>(dice.vector(3.1));
    const Result result = solver().solve(target);
    EXPECT_NE(result.proof, Proof::closed_form);
    if (result.proof != Proof::sweep) continue;
    ++none;
    EXPECT_EQ(solver().solve_batch({target})[0].proof, Proof::sweep);
    EXPECT_EQ(solver().solve_all(target).proof, Proof::sweep);
    EXPECT_TRUE(iksel_test::brute_force(solver(), target, 200).empty()) << i;
  }
  EXPECT_GE(none, 1);
}

/// Axes that lie off, as by a rounded pi, leave a doubt at limits and where roots all but meet.
TEST(RootSweep, WhatRootsLeaveInDoubtIntervalsTell) {
  const Robot& robot = iksel_test::robot("gen3_6dof");
  const Solver& solver = iksel_test::solver("gen3_6dof");
  Dice dice(iksel_test::seed());
  int noes = 0;
  int proven = 0;
  for (Pose target : iksel_test::random_targets(robot, iksel_test::cases(3000, 3000))) {
    target.linear() = iksel_test::rotation_of_rpy<double>(dice.vector(3.1));
    const Result result = solver.solve(target);
    noes += !result.success();
    proven += !result.success() && result.proof != Proof::none;
  }
  EXPECT_GT(noes, 1000);
  EXPECT_GE(proven, noes * 99 / 100) << "seed " << iksel_test::seed();
}

/// A joint past its limit by far more than the tolerances, or by what they allow.
TEST_P(RootSweeps, WhatLiesJustOutsideTheLimitsIsTold) {
  constexpr double kTolerance = 1e-6;
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(200, 50);
  const Eigen::MatrixXd random = robot().random_configurations(n, iksel_test::seed() + 4);
  int outside = 0;
  int told = 0;
  for (int i = 0; i < n; ++i) {
    JointVector q = random.row(i);
    const int j = dice.pick(6);
    const bool is_upper = dice.chance(0.5);
    const double limit = (is_upper ? robot().upper() : robot().lower())[j];
    if (!std::isfinite(limit) || robot().model().joints.is_periodic(j)) continue;
    const double outwards = is_upper ? 1 : -1;
    const auto is_beyond = [&](double by) {
      q[j] = limit + by * outwards;
      JointVector seed = q;
      for (int k = 0; k < 6; ++k) seed[k] += dice.uniform(-1e-5, 1e-5);
      return iksel::is_beyond_limits(robot().model(), robot().fk(q), seed, kTolerance, kTolerance);
    };
    // The TCP is moved by at most twice the reach times that: the limit itself is an answer.
    EXPECT_FALSE(is_beyond(0.3 * kTolerance / std::max(1.0, robot().reach())))
        << q.transpose() << ", seed " << iksel_test::seed();
    EXPECT_FALSE(is_beyond(-1e-4));
    const bool is_told = is_beyond(5e-4);
    if (is_told) {
      // Its own branch gives no answer: all that there are differ.
      for (const Result& result : solver().solve_all(robot().fk(q)).all) {
        EXPECT_GT(iksel_test::distance(robot(), result.q, q), 1e-4);
      }
    }
    ++outside;
    told += is_told;
  }
  EXPECT_GE(told, outside * 8 / 10) << "seed " << iksel_test::seed();
}

TEST_P(RootSweeps, LargeTolerancesAreAllowedFor) {
  Dice dice(iksel_test::seed());
  const Eigen::MatrixXd random =
      robot().random_configurations(iksel_test::cases(100), iksel_test::seed());
  std::vector<JointVector> reached;
  for (int i = 0; i < random.rows(); ++i) reached.emplace_back(random.row(i));
  iksel_test::expect_no_proof_at_large_tolerances(robot(), reached, dice);
}

/// Of 100,000 reachable targets near singularities two that were called a no: the nominal arm's
/// roots are four that all but meet, and none of them is real.
TEST(RootSweep, WhereFourRootsAllButMeetSomeAreLookedFor) {
  const Robot& robot = iksel_test::robot("gen3_6dof");
  const Solver& solver = iksel_test::solver("gen3_6dof");
  iksel_test::Judge judge(robot);
  JointVector one(6);
  one << -3.1031627827683446, 0.30214768907649203, -0.0010271418180800573, -1.1688457655930569,
      0.009419768124786287, -1.2844756415146932;
  JointVector other(6);
  other << -2.2398586310939304, -0.5237192918331071, 0.0017364701003068639, 1.32078972278331,
      -0.007848187627975456, 2.1816112614960224;
  for (const JointVector& q : {one, other}) {
    const Pose target = robot.fk(q);
    const Result result = solver.solve(target);
    ASSERT_TRUE(result.success()) << q.transpose();
    judge.expect_solution(target, result.q);
    EXPECT_TRUE(solver.solve_all(target).success());
  }
}

/// Where elbow and wrist are both all but straight the residual is next to nothing for any angle,
/// and what rounding its file left of pi puts its roots out of reach: of 20,000 such poses 1,217
/// had no solution for solve_all, and 742 none near another configuration.
TEST(RootSweep, WhereElbowAndWristAreStraightRootsAreFarApart) {
  const Robot& robot = iksel_test::robot("gen3_6dof");
  const Solver& solver = iksel_test::solver("gen3_6dof");
  iksel_test::Judge judge(robot);
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(200);
  const Eigen::MatrixXd random = robot.random_configurations(2 * n, iksel_test::seed() + 5);
  for (int i = 0; i < n; ++i) {
    JointVector q = random.row(i);
    q[2] = dice.uniform(-2e-3, 2e-3);
    q[4] = dice.uniform(-2e-3, 2e-3);
    const Pose target = robot.fk(q);
    EXPECT_TRUE(solver.solve_all(target).success()) << q.transpose();
    iksel::SolveRequest request;
    request.near = random.row(n + i);
    const Result result = solver.solve(target, request);
    ASSERT_TRUE(result.success()) << q.transpose() << ", seed " << iksel_test::seed();
    judge.expect_solution(target, result.q);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, RootSweeps,
                         testing::Values("cvr038", "cvrb1213", "gen3_6dof", "xarm6"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
