// SPDX-License-Identifier: BSD-3-Clause
// What a solution tells about others, against finite differences.
#include <gtest/gtest.h>

#include <cmath>
#include <iksel/iksel.hpp>

#include "base/pseudo_inverse.hpp"
#include "kinematics/chain_model.hpp"
#include "robots.hpp"
#include "seeds/fold_partner.hpp"

namespace {

using iksel::Jacobian;
using iksel::JointVector;
using iksel::Matrix6;
using iksel::Robot;
using iksel::Vector6;

class FoldPartners : public testing::TestWithParam<std::string> {};

Jacobian jacobian(const Robot& robot, const JointVector& q) {
  Jacobian J;
  robot.model().fk_jacobian(q.data(), J);
  return J;
}

/// The joint direction that moves the tip least, or of those across `other` the one that does; by
/// powers of a matrix whose largest eigenvalue belongs to it.
Vector6 least_direction(const Jacobian& J, const Vector6* other) {
  const Matrix6 square = J.transpose() * J;
  Matrix6 power = Matrix6::Identity() * square.trace() - square;
  if (other != nullptr) power -= *other * other->transpose() * square.trace();
  for (int k = 0; k < 40; ++k) {
    power = (power * power).eval();
    power /= power.trace();
  }
  Eigen::Index column = 0;
  power.diagonal().maxCoeff(&column);
  return power.col(column).normalized();
}

/// The guess is where the parabola through the motion along the least singular direction returns.
TEST_P(FoldPartners, TheOtherOfAPairIsWhereSecondOrderPutsIt) {
  constexpr double kStep = 1e-5;
  const Robot& robot = iksel_test::robot(GetParam());
  const Eigen::MatrixXd q = robot.random_configurations(5000, iksel_test::seed());
  int paired = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const JointVector at = q.row(i);
    const Jacobian J = jacobian(robot, at);
    const Vector6 v = least_direction(J, nullptr);
    const double sigma = (J * v).norm();
    // Inverse iteration takes three steps: nearly equal ones are not told apart.
    if (sigma > 0.1 * (J * least_direction(J, &v)).norm() || sigma < 1e-6) continue;
    const auto around = iksel::find_fold_partner(robot.model(), J, at, 0);
    const Eigen::VectorXd u = J * v / sigma;
    const JointVector ahead = at + kStep * v;
    const JointVector behind = at - kStep * v;
    const Eigen::VectorXd change =
        (jacobian(robot, ahead) * v - jacobian(robot, behind) * v) / (2 * kStep);
    const double t = -2 * sigma / u.dot(change);
    if (!(std::abs(t) < 1.4)) continue;
    ASSERT_TRUE(around.paired) << "row " << i;
    ++paired;
    EXPECT_LT((around.other - (at + t * v)).norm(), 0.01 * std::abs(t) + 1e-6) << "row " << i;
  }
  EXPECT_GT(paired, 100);
}

INSTANTIATE_TEST_SUITE_P(Robots, FoldPartners, testing::Values("cvr038", "cvrb1213", "ur3_wrs"),
                         iksel_test::name_of);

}  // namespace
