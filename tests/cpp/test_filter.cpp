// SPDX-License-Identifier: BSD-3-Clause
// Solutions that a filter lets through.
#include <gtest/gtest.h>

#include <algorithm>
#include <iksel/iksel.hpp>
#include <stdexcept>
#include <string>

#include "branches.hpp"
#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;
using iksel::Status;
using iksel_test::noisy;

TEST(Filter, FindsWheneverSolveAllHasOneThatPasses) {
  for (const char* name : {"ur3", "ur10e", "cvr038", "cvrb1213", "panda", "irb14050"}) {
    const Solver& solver = iksel_test::solver(name);
    const Robot& robot = solver.robot();
    iksel_test::Judge judge(robot);
    const int n = iksel_test::cases(300, 60) / 2;
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
        judge.expect_solution(target, result.q);
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
  const Solver& solver = iksel_test::solver("ur3");
  const Robot& robot = solver.robot();
  iksel_test::Judge judge(robot);
  const int n = iksel_test::cases(300, 30);
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
    judge.expect_solution(target, result.q);
    EXPECT_TRUE(passes(result.q));
    if (!all.success()) continue;
    farther += result.move > all.all.front().move + 2e-3;
    turned += result.move > 4;
  }
  EXPECT_LE(farther, n / 100) << "seed " << iksel_test::seed();
  EXPECT_GT(turned, 0);
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
