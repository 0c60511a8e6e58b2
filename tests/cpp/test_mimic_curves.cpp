// SPDX-License-Identifier: BSD-3-Clause
// Joints that follow others by a curve: the curve itself, and kernels against KDL.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/motion_curve.hpp"
#include "robots.hpp"

namespace {

using iksel::Jacobian;
using iksel::JointVector;
using iksel::Kinematics;
using iksel::MimicCurve;
using iksel::MotionCurve;
using iksel::Robot;
using iksel::RobotOptions;

std::pair<double, double> wave(double q) {
  return {0.7 * std::sin(1.3 * q), 0.91 * std::cos(1.3 * q)};
}

/// A robot of which joint 4 follows joint 2, and joint 5 joint 0, by waves.
Robot waving(const std::string& name) {
  const Robot& from = iksel_test::robot(name);
  RobotOptions options = from.options();
  for (const auto& [joint, follows] : {std::pair{4, 2}, std::pair{5, 0}}) {
    const auto at = static_cast<std::size_t>(follows);
    options.mimic_curves.push_back(MimicCurve::sampled(
        from.joint_names()[static_cast<std::size_t>(joint)], from.joint_names()[at],
        std::max(from.lower()[follows], -1.0), std::min(from.upper()[follows], 1.0), wave));
  }
  return Robot::from_urdf_string(from.urdf(), options);
}

TEST(MotionCurve, FollowsTheFunctionAndItsSlope) {
  const MimicCurve curve = MimicCurve::sampled("a", "b", -2, 3, wave);
  const MotionCurve motion(curve.q, curve.values, curve.slopes);
  for (int i = 0; i <= 10'000; ++i) {
    const double q = -2 + 5e-4 * i;
    EXPECT_NEAR(motion.at(q).value, wave(q).first, 1e-10);
    EXPECT_NEAR(motion.at(q).slope, wave(q).second, 1e-6);
  }
  EXPECT_NEAR(motion.steepest(), 0.91, 1e-3);
}

TEST(MotionCurve, IsStraightBeyondItsEnds) {
  const MotionCurve motion({0, 1, 3}, {0, 1, 2}, {2, 0.5, -1});
  EXPECT_DOUBLE_EQ(motion.at(-2).value, -4);
  EXPECT_DOUBLE_EQ(motion.at(-2).slope, 2);
  EXPECT_DOUBLE_EQ(motion.at(5).value, 0);
  EXPECT_DOUBLE_EQ(motion.at(5).slope, -1);
}

TEST(MotionCurve, SplinesOfCubicsAreThoseCubics) {
  const auto cubic = [](double q) { return 1 + q * (0.5 + q * (-2 + 0.3 * q)); };
  const auto slope = [](double q) { return 0.5 + q * (-4 + 0.9 * q); };
  for (const std::vector<double>& at :
       {std::vector<double>{-1, 0.2, 0.9, 2}, {-1, -0.8, 0, 0.3, 1.4, 2, 5}}) {
    std::vector<double> values;
    for (const double q : at) values.push_back(cubic(q));
    const MotionCurve motion(at, values, {});
    for (double q = -1; q < 2; q += 0.01) {
      EXPECT_NEAR(motion.at(q).value, cubic(q), 1e-12);
      EXPECT_NEAR(motion.at(q).slope, slope(q), 1e-11);
    }
  }
}

TEST(MotionCurve, NoValueLiesOutsideOfItsBounds) {
  const MotionCurve motion({0, 1, 2, 4}, {0, 3, -1, 0}, {9, -4, 2, 30});
  for (const auto& [lower, upper] : {std::pair{0.0, 4.0}, std::pair{0.3, 0.6}}) {
    const auto bounds = motion.values_between(lower, upper);
    for (double q = lower; q <= upper; q += 1e-3) {
      EXPECT_GE(motion.at(q).value, bounds.lower);
      EXPECT_LE(motion.at(q).value, bounds.upper);
      EXPECT_LE(std::abs(motion.at(q).slope), motion.steepest());
    }
  }
}

TEST(MimicCurves, KernelEqualsKdl) {
  for (const char* name : {"ur3", "panda", "cvr038"}) {
    const Robot robot = waving(name);
    EXPECT_EQ(robot.dof(), iksel_test::robot(name).dof() - 2);
    const Eigen::MatrixXd q =
        robot.random_configurations(iksel_test::cases(300), iksel_test::seed());
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const JointVector at = q.row(i);
      const Eigen::Matrix4d off = robot.fk(at).matrix() - robot.fk(at, Kinematics::kdl).matrix();
      EXPECT_LT(off.lpNorm<Eigen::Infinity>(), 1e-12);
      const Jacobian difference = robot.jacobian(at) - robot.jacobian(at, Kinematics::kdl);
      EXPECT_LT(difference.lpNorm<Eigen::Infinity>(), 1e-12);
    }
  }
}

TEST(MimicCurves, SlidesThatFollowAddToTheReach) {
  // Of a free turn, a slide from 0.5 m to 1.5 m.
  const std::string urdf = R"(<robot name="slider">
    <link name="a"/><link name="b"/><link name="c"/>
    <joint name="turn" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
    <joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
      <limit lower="0" upper="2" effort="1" velocity="1"/></joint></robot>)";
  RobotOptions options;
  options.mimic_curves = {MimicCurve::sampled("slide", "turn", -1, 1, [](double q) {
    return std::pair{1 + 0.5 * std::sin(q * 1.5), 0.75 * std::cos(q * 1.5)};
  })};
  const Robot robot = Robot::from_urdf_string(urdf, options);
  EXPECT_EQ(robot.dof(), 1);
  EXPECT_DOUBLE_EQ(robot.lower()[0], -1);
  for (double q = -1; q <= 1; q += 0.01) {
    const JointVector at = JointVector::Constant(1, q);
    const double distance = (robot.fk(at).translation() - robot.reach_centre()).norm();
    EXPECT_NEAR(distance, 1 + 0.5 * std::sin(q * 1.5), 1e-9);
    EXPECT_LE(distance, robot.reach());
  }
  EXPECT_LT(robot.reach(), 1.51);
}

}  // namespace
