// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <iksel/error.hpp>
#include <iksel/pose.hpp>
#include <iksel/robot.hpp>

#include "base/random.hpp"
#include "base/rotation.hpp"
#include "robots.hpp"

namespace {

using iksel_test::kPi;

Eigen::Vector3d random_axis(iksel::Random& random) {
  Eigen::Vector3d v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  return v.normalized();
}

TEST(Rotation, VectorSurvivesTheWayThroughTheMatrix) {
  iksel::Random random(iksel_test::seed());
  for (int i = 0; i < 20000; ++i) {
    // From 1e-12 rad to pi - 1e-12, both ends dense.
    const double small = std::pow(10.0, random.uniform(-12, 0));
    const double angle = i % 2 == 0 ? small * kPi : kPi - small;
    const Eigen::Vector3d w = angle * random_axis(random);
    const Eigen::Vector3d back = iksel::to_rotation_vector(iksel::from_rotation_vector(w));
    const double error = std::min((back - w).norm(), (back + w).norm());
    // At pi both signs are one rotation.
    const bool at_pi = kPi - angle < 1e-7;
    EXPECT_LT(at_pi ? error : (back - w).norm(), 1e-9 * std::max(angle, 1e-6)) << angle;
  }
}

TEST(Rotation, TinyAnglesKeepTheirRelativePrecision) {
  for (const double angle : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    R(1, 0) = angle;
    R(0, 1) = -angle;
    EXPECT_NEAR(iksel::to_rotation_vector(R).norm() / angle, 1.0, 1e-6);
  }
  EXPECT_EQ(iksel::to_rotation_vector(Eigen::Matrix3d::Identity()).norm(), 0.0);
}

TEST(Rotation, RollPitchYawGivesTheMatrixBack) {
  iksel::Random random(iksel_test::seed());
  for (int i = 0; i < 5000; ++i) {
    Eigen::Vector3d rpy(random.uniform(-kPi, kPi), random.uniform(-kPi / 2, kPi / 2),
                        random.uniform(-kPi, kPi));
    // Where roll and yaw turn about one axis, and nearly so.
    if (i % 10 == 0) rpy[1] = kPi / 2;
    if (i % 10 == 1) rpy[1] = kPi / 2 - std::pow(10.0, random.uniform(-15, -3));
    const auto matrix = [](const Eigen::Vector3d& a) -> Eigen::Matrix3d {
      return (Eigen::AngleAxisd(a[2], Eigen::Vector3d::UnitZ()) *
              Eigen::AngleAxisd(a[1], Eigen::Vector3d::UnitY()) *
              Eigen::AngleAxisd(a[0], Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
    };
    const Eigen::Matrix3d R = matrix(rpy);
    EXPECT_LT((matrix(iksel::to_roll_pitch_yaw(R)) - R).norm(), 1e-12);
  }
}

TEST(CheckPose, NamesWhatIsWrong) {
  const auto message = [](const iksel::Pose& pose) -> std::string {
    try {
      iksel::check_pose(pose, "target");
    } catch (const iksel::InvalidArgumentError& error) {
      return error.what();
    }
    return "";
  };
  iksel::Pose pose = iksel::Pose::Identity();
  EXPECT_EQ(message(pose), "");
  pose.translation().x() = std::nan("");
  EXPECT_EQ(message(pose), "target: not finite");
  pose = iksel::Pose::Identity();
  pose.linear()(0, 0) = 1.001;
  EXPECT_NE(message(pose).find("target: not rigid, R^T R differs from the identity by 0.002"),
            std::string::npos);
  pose = iksel::Pose::Identity();
  pose.linear()(2, 2) = -1;
  EXPECT_NE(message(pose).find("reflection"), std::string::npos);
  pose = iksel::Pose::Identity();
  pose.matrix()(3, 0) = 1;
  EXPECT_NE(message(pose).find("last row"), std::string::npos);
}

}  // namespace
