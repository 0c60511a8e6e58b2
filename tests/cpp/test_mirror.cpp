// SPDX-License-Identifier: BSD-3-Clause
// What a solution tells about others, against Eigen and finite differences.
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>
#include <iksel/iksel.hpp>

#include "kinematics/chain_model.hpp"
#include "math/random.hpp"
#include "robots.hpp"
#include "solver/mirror.hpp"

namespace {

using iksel::Jacobian;
using iksel::JointVector;
using iksel::Robot;

class SixJoints : public testing::TestWithParam<iksel_test::RobotCase> {};

Jacobian jacobian(const Robot& robot, const JointVector& q) {
  Jacobian J;
  robot.model().fk_jacobian(q.data(), J);
  return J;
}

TEST_P(SixJoints, OrientationIsTheSignOfTheDeterminant) {
  const Robot robot = iksel_test::load(GetParam());
  const Eigen::MatrixXd q = robot.random_configurations(5000, iksel_test::seed());
  int positive = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Jacobian J = jacobian(robot, q.row(i));
    const double determinant = Eigen::MatrixXd(J).determinant();
    if (std::abs(determinant) < 1e-14) continue;
    EXPECT_EQ(iksel::look_around(J, q.row(i), 0).orientation, determinant > 0 ? 1 : -1)
        << "row " << i << ", determinant " << determinant;
    positive += determinant > 0 ? 1 : 0;
  }
  EXPECT_GT(positive, q.rows() / 10);
  EXPECT_LT(positive, q.rows() * 9 / 10);
}

/// The guess is where the parabola through the motion along the least singular direction returns.
TEST_P(SixJoints, TheOtherOfAPairIsWhereSecondOrderPutsIt) {
  constexpr double kStep = 1e-5;
  const Robot robot = iksel_test::load(GetParam());
  const Eigen::MatrixXd q = robot.random_configurations(5000, iksel_test::seed());
  int paired = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const JointVector at = q.row(i);
    const Jacobian J = jacobian(robot, at);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeFullV);
    const Eigen::VectorXd sigma = svd.singularValues();
    // Inverse iteration takes three steps: nearly equal ones are not told apart.
    if (sigma[5] > 0.1 * sigma[4] || sigma[5] < 1e-9) continue;
    const auto around = iksel::look_around(J, at, 0);
    const Eigen::VectorXd v = svd.matrixV().col(5);
    const Eigen::VectorXd u = J * v / sigma[5];
    const JointVector ahead = at + kStep * v;
    const JointVector behind = at - kStep * v;
    const Eigen::VectorXd change =
        (jacobian(robot, ahead) * v - jacobian(robot, behind) * v) / (2 * kStep);
    const double t = -2 * sigma[5] / u.dot(change);
    if (!(std::abs(t) < 1.4)) continue;
    ASSERT_TRUE(around.paired) << "row " << i;
    ++paired;
    EXPECT_LT((around.other - (at + t * v)).norm(), 0.01 * std::abs(t) + 1e-6) << "row " << i;
  }
  EXPECT_GT(paired, 100);
}

INSTANTIATE_TEST_SUITE_P(Robots, SixJoints,
                         testing::Values(iksel_test::paper_robots()[0],
                                         iksel_test::paper_robots()[1],
                                         iksel_test::paper_robots()[2]),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace
