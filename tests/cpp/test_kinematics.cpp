// SPDX-License-Identifier: BSD-3-Clause
// FK and Jacobian: kernel against KDL, both against finite differences.
#include <gtest/gtest.h>

#include <iksel/iksel.hpp>
#include <string>

#include "robots.hpp"

namespace {

using iksel::Jacobian;
using iksel::JointVector;
using iksel::Kinematics;
using iksel::Pose;
using iksel::Robot;

class KinematicsOfRobots : public testing::TestWithParam<std::string> {};

TEST_P(KinematicsOfRobots, KernelEqualsKdl) {
  const Robot& robot = iksel_test::robot(GetParam());
  const Eigen::MatrixXd q = robot.random_configurations(iksel_test::cases(300), iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const JointVector at = q.row(i);
    const Pose kernel = robot.fk(at);
    const Pose kdl = robot.fk(at, Kinematics::kdl);
    EXPECT_LT((kernel.matrix() - kdl.matrix()).lpNorm<Eigen::Infinity>(), 1e-12);
    const Jacobian difference = robot.jacobian(at) - robot.jacobian(at, Kinematics::kdl);
    EXPECT_LT(difference.lpNorm<Eigen::Infinity>(), 1e-12);
  }
}

TEST_P(KinematicsOfRobots, JacobianIsTheDerivative) {
  const Robot& robot = iksel_test::robot(GetParam());
  const Eigen::MatrixXd q = robot.random_configurations(20, iksel_test::seed());
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const JointVector at = q.row(i);
    const Jacobian J = robot.jacobian(at);
    for (int j = 0; j < robot.dof(); ++j) {
      JointVector forward = at;
      JointVector backward = at;
      forward[j] += kStep;
      backward[j] -= kStep;
      const Eigen::Matrix<double, 6, 1> twist =
          iksel::pose_error(robot.fk(forward), robot.fk(backward)) / (2 * kStep);
      EXPECT_LT((twist - J.col(j)).lpNorm<Eigen::Infinity>(), 1e-8) << "joint " << j;
    }
  }
}

TEST_P(KinematicsOfRobots, NothingLiesBeyondTheReach) {
  const Robot& robot = iksel_test::robot(GetParam());
  const Eigen::MatrixXd q = robot.random_configurations(500, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    EXPECT_LE((robot.fk(q.row(i)).translation() - robot.reach_centre()).norm(),
              robot.reach() + 1e-12);
  }
}

TEST_P(KinematicsOfRobots, ToolMovesThePoseAndNotTheHash) {
  const Robot& robot = iksel_test::robot(GetParam());
  Pose tool = Pose::Identity();
  tool.translate(Eigen::Vector3d(0.1, -0.2, 0.3))
      .rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  const Robot with_tool = robot.with_tcp(tool);
  EXPECT_EQ(robot.chain_hash(), with_tool.chain_hash());
  const Eigen::MatrixXd q = robot.random_configurations(10, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Pose bare = robot.with_tcp(Pose::Identity()).fk(q.row(i));
    EXPECT_LT(((bare * tool).matrix() - with_tool.fk(q.row(i)).matrix()).norm(), 1e-12);
    EXPECT_LT(((bare * tool).matrix() - with_tool.fk(q.row(i), Kinematics::kdl).matrix()).norm(),
              1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, KinematicsOfRobots, testing::ValuesIn(iksel_test::all_robots()),
                         iksel_test::name_of);

TEST(Axes, NearlyOppositeToZKeepTheirDigits) {
  for (const char* axis : {"0 0 -1", "0 -1e-7 -1", "1e-7 0 -1", "3e-7 -2e-7 -1", "0 1e-9 -1",
                           "1e-16 1e-17 -1", "0.8 0.1 -0.6", "0.1 0.8 -0.4999"}) {
    const std::string limit =
        "<limit lower='-3' upper='3' effort='1' velocity='1'/><origin xyz='1 2 3'/>";
    const Robot robot = Robot::from_urdf_string(
        std::string("<robot name='r'><link name='a'/><link name='b'/><link name='c'/>") +
        "<joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis xyz='" + axis +
        "'/>" + limit + "</joint><joint name='k' type='revolute'><parent link='b'/>" +
        "<child link='c'/><axis xyz='1 0 0'/>" + limit + "</joint></robot>");
    const Eigen::MatrixXd q = robot.random_configurations(20, iksel_test::seed());
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const JointVector at = q.row(i);
      const Eigen::Matrix4d difference =
          robot.fk(at).matrix() - robot.fk(at, Kinematics::kdl).matrix();
      EXPECT_LT(difference.lpNorm<Eigen::Infinity>(), 1e-14) << axis;
    }
  }
}

TEST(RandomConfigurations, AreInsideTheLimitsAndRepeat) {
  const Robot& robot = iksel_test::robot("ur3e");  // with a continuous joint
  const Eigen::MatrixXd q = robot.random_configurations(1000, 3);
  EXPECT_EQ(q, robot.random_configurations(1000, 3));
  EXPECT_NE(q, robot.random_configurations(1000, 4));
  for (Eigen::Index i = 0; i < q.rows(); ++i) EXPECT_TRUE(robot.within_limits(q.row(i)));
}

TEST(Robot, RefusesAConfigurationOfTheWrongLength) {
  const Robot& robot = iksel_test::robot("cvr038");
  EXPECT_THROW(robot.fk(JointVector::Zero(5)), iksel::InvalidArgumentError);
  EXPECT_THROW(robot.jacobian(JointVector::Constant(6, std::nan(""))), iksel::InvalidArgumentError);
}

}  // namespace
