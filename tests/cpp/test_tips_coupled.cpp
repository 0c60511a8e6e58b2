// SPDX-License-Identifier: BSD-3-Clause
// Coupled limits of robots with several tips: of joints of one arm, of shared ones, of both, and of
// two arms.
#include <gtest/gtest.h>

#include <iksel/iksel.hpp>
#include <string>
#include <vector>

#include "robots.hpp"
#include "trees.hpp"

namespace {

using iksel::CoupledLimit;
using iksel::JointVector;
using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;

/// Joint j of the left arm, or of the right.
std::string left(int j) { return "l_" + iksel_test::robot("panda").joint_names()[j]; }
std::string right(int j) { return "r_" + iksel_test::robot("panda").joint_names()[j]; }

Robot bound(const std::vector<CoupledLimit>& limits) {
  const Robot& arm = iksel_test::robot("panda");
  iksel::RobotOptions options = iksel_test::tips_of({"l_" + arm.tip_link(), "r_" + arm.tip_link()});
  options.coupled_limits = limits;
  return Robot::from_urdf_string(iksel_test::two_arms_on_torso(arm), options);
}

struct Coupled {
  std::string name;
  std::vector<CoupledLimit> limits;
};

std::vector<Coupled> all_coupled() {
  const CoupledLimit of_arm{{{left(1), 1}, {left(3), -1}}, -0.5, 1.5};
  const CoupledLimit of_torso{{{"lift", 4}, {"turn", 1}}, -0.6, 1.2};
  const CoupledLimit of_both{{{"turn", 1}, {left(0), 1}}, -0.8, 0.8};
  const CoupledLimit of_arms{{{left(0), 1}, {right(0), -1}}, -0.7, 0.7};
  return {{"one_arm", {of_arm}},
          {"shared", {of_torso}},
          {"shared_and_arm", {of_both}},
          {"both_arms", {of_arms}},
          {"all", {of_arm, of_torso, of_both, of_arms}}};
}

class CoupledTips : public testing::TestWithParam<Coupled> {
 protected:
  /// Whether the sums lie inside, joint by joint from the names.
  static bool holds(const Robot& robot, const JointVector& q) {
    const auto& names = robot.joint_names();
    for (const CoupledLimit& limit : GetParam().limits) {
      double sum = 0;
      for (const auto& [name, coefficient] : limit.coefficients) {
        sum += coefficient * q[std::find(names.begin(), names.end(), name) - names.begin()];
      }
      if (!(sum >= limit.lower - 1e-12 && sum <= limit.upper + 1e-12)) return false;
    }
    return true;
  }

  static void expect_answer(const Robot& robot, const std::vector<Pose>& targets,
                            const JointVector& q) {
    EXPECT_TRUE(holds(robot, q));
    EXPECT_TRUE(robot.within_limits(q));
    const std::vector<Pose> reached = robot.tip_poses(q);
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const auto error = iksel::pose_error(targets[i], reached[i]);
      EXPECT_LT(error.head<3>().norm(), 1.001e-6);
      EXPECT_LT(error.tail<3>().norm(), 1.001e-6);
    }
  }
};

TEST_P(CoupledTips, ReachableTargetsAreSolvedInside) {
  const Solver solver(bound(GetParam().limits));
  const Robot& robot = solver.robot();
  const int n = iksel_test::cases(200, 30);
  const iksel::Matrix random =
      robot.random_configurations(static_cast<std::size_t>(n), iksel_test::seed());
  for (int i = 0; i < n; ++i) {
    const JointVector q = random.row(i);
    EXPECT_TRUE(holds(robot, q));
    const std::vector<Pose> targets = robot.tip_poses(q);
    const Result result = solver.solve(targets);
    ASSERT_TRUE(result.success()) << "target " << i << ", seed " << iksel_test::seed();
    expect_answer(robot, targets, result.q);
    SolveRequest request;
    request.near = q;
    const Result nearest = solver.solve(targets, request);
    ASSERT_TRUE(nearest.success()) << "target " << i << ", seed " << iksel_test::seed();
    expect_answer(robot, targets, nearest.q);
    EXPECT_LT(nearest.move, 1e-3) << "target " << i << ", seed " << iksel_test::seed();
  }
}

TEST_P(CoupledTips, NearFromOutsideEndsInside) {
  const Solver solver(bound(GetParam().limits));
  const Robot& robot = solver.robot();
  const int n = iksel_test::cases(40, 20);
  const auto rows = static_cast<std::size_t>(n);
  const iksel::Matrix random = robot.random_configurations(rows, iksel_test::seed());
  const iksel::Matrix from = bound({}).random_configurations(rows, iksel_test::seed() + 1);
  int farther = 0;
  for (int i = 0; i < n; ++i) {
    const std::vector<Pose> targets = robot.tip_poses(random.row(i));
    SolveRequest request;
    request.near = from.row(i);
    const Result result = solver.solve(targets, request);
    ASSERT_TRUE(result.success()) << "target " << i << ", seed " << iksel_test::seed();
    expect_answer(robot, targets, result.q);
    farther += result.move > (random.row(i) - from.row(i)).norm() + 1e-6;
  }
  // The search is bounded: with or without limits some one of a hundred is farther than is known.
  EXPECT_LE(farther, n / 8) << "of " << n << ", seed " << iksel_test::seed();
}

INSTANTIATE_TEST_SUITE_P(Limits, CoupledTips, testing::ValuesIn(all_coupled()),
                         [](const auto& info) { return info.param.name; });

TEST(CoupledTips, ArmsAndChainsKnowTheirOwnLimits) {
  const Robot robot = bound(all_coupled().back().limits);
  ASSERT_EQ(robot.options().coupled_limits.size(), 4U);
  EXPECT_EQ(robot.chain(0).options().coupled_limits.size(), 3U);  // not that of both arms
  EXPECT_EQ(robot.chain(1).options().coupled_limits.size(), 1U);  // the torso's
}

TEST(CoupledTips, ErrorsNameTheLimit) {
  const auto message = [](const CoupledLimit& limit) {
    try {
      bound({{{{left(1), 1}}, -1, 1}, limit});
    } catch (const iksel::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string unknown = message({{{"l_panda_jiont1", 1}}, -1, 1});
  EXPECT_NE(unknown.find("coupled_limits[1]"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("l_panda_joint1"), std::string::npos) << unknown;
  EXPECT_NE(message({{{left(0), 1}, {right(0), 1}}, 50, 60}).find("coupled_limits[1]"),
            std::string::npos);
}

}  // namespace
