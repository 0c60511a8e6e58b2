// SPDX-License-Identifier: BSD-3-Clause
// 100,000 random reachable poses per paper robot and preset: nothing that says success is not one,
// by KDL's FK and the limits.
#include <gtest/gtest.h>

#include <iksel/iksel.hpp>
#include <memory>

#include "kinematics/chain_model.hpp"
#include "robots.hpp"

namespace {

class PaperRobots : public testing::TestWithParam<std::tuple<iksel_test::RobotCase, bool>> {};

TEST_P(PaperRobots, NeverClaimWhatIsNot) {
  const auto& [robot_case, paper] = GetParam();
  const iksel::Robot robot = iksel_test::load(robot_case);
  const iksel::SolverOptions options =
      paper ? iksel::SolverOptions::paper() : iksel::SolverOptions{};
  const iksel::Solver solver(robot, options);
  const auto n = static_cast<std::size_t>(iksel_test::cases(100'000));
  const Eigen::MatrixXd q = robot.random_configurations(n, iksel_test::seed());
  const auto kdl = robot.model().make_kdl();
  std::vector<iksel::Pose> targets;
  for (Eigen::Index i = 0; i < q.rows(); ++i) targets.push_back(kdl->fk(q.row(i)));
  const auto results = solver.solve_batch(targets);
  std::size_t solved = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!results[i].success()) continue;
    ++solved;
    const auto e = iksel::pose_error(targets[i], kdl->fk(results[i].q));
    ASSERT_LE(e.head<3>().norm(), options.position_tolerance + 1e-13) << "target " << i;
    ASSERT_LE(e.tail<3>().norm(), options.rotation_tolerance + 1e-13) << "target " << i;
    for (int j = 0; j < robot.dof(); ++j) {
      ASSERT_GE(results[i].q[j], robot.lower()[j]) << "target " << i;
      ASSERT_LE(results[i].q[j], robot.upper()[j]) << "target " << i;
    }
  }
  RecordProperty("solved", static_cast<int>(solved));
  EXPECT_GE(solved, n * 70 / 100) << "seed " << iksel_test::seed();
}

INSTANTIATE_TEST_SUITE_P(Presets, PaperRobots,
                         testing::Combine(testing::ValuesIn(iksel_test::paper_robots()),
                                          testing::Bool()),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) +
                                  (std::get<1>(info.param) ? "_paper" : "_default");
                         });

}  // namespace
