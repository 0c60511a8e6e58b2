// SPDX-License-Identifier: BSD-3-Clause
// What joints that turn about one axis share, against any other way to share it.
#include <gtest/gtest.h>

#include <cmath>

#include "closed_chains.hpp"
#include "goal/coaxial_joints.hpp"
#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel_test::kTwoPi;

/// Seven axes, of which 2 and 3, and 5, 6 and 7, are one each.
iksel_test::AxisChain make_axes(iksel_test::AxisMaker& maker, iksel_test::Dice& dice) {
  iksel_test::AxisChain axes;
  for (std::size_t j = 0; j < 7; ++j) {
    if (j == 2 || j > 4) {
      axes.h.push_back(dice.chance(0.5) ? axes.h[j - 1] : Eigen::Vector3d(-axes.h[j - 1]));
      axes.p.push_back(axes.p[j - 1] + dice.uniform(-0.3, 0.3) * axes.h[j]);
    } else {
      axes.h.push_back(maker.direction());
      axes.p.push_back(dice.vector(0.5));
    }
  }
  return axes;
}

TEST(CoaxialJoints, ShareWhatIsNearest) {
  iksel_test::Dice dice(iksel_test::seed());
  iksel_test::AxisMaker maker(dice);
  for (int round = 0; round < iksel_test::cases(30); ++round) {
    const iksel_test::AxisChain axes = make_axes(maker, dice);
    const double limit = dice.uniform(0.5, 5);
    const iksel::Robot robot = iksel_test::make_robot(axes, dice, limit);
    const iksel::CoaxialJoints coaxial(robot.model());
    ASSERT_TRUE(coaxial.has_any());
    iksel::Matrix draws = robot.random_configurations(2, iksel_test::seed() + 1);
    JointVector weights = JointVector::Ones(7);
    for (int j = 0; j < 7; ++j) weights[j] = dice.uniform(0.2, 2);
    const iksel::JointMove move(weights);
    const JointVector given = draws.row(0).transpose();
    const JointVector near = draws.row(1).transpose();
    JointVector found = given;
    coaxial.bring_nearest(near, move, found);
    ASSERT_TRUE(robot.within_limits(found));
    ASSERT_LT((robot.fk(found).matrix() - robot.fk(given).matrix()).norm(), 1e-9);
    for (int i = 0; i < 300; ++i) {
      JointVector other = given;
      for (const int joint : {2, 5, 6}) {
        // What one joint turns, the one before it turns back, and maybe whole turns more.
        const auto j = static_cast<std::size_t>(joint);
        const double side = axes.h[j].dot(axes.h[j - 1]) < 0 ? -1 : 1;
        const double turn = dice.uniform(-limit, limit) - other[joint];
        const double whole = kTwoPi * std::round(dice.uniform(-1.5, 1.5));
        other[joint] += turn;
        other[joint - 1] += whole - side * turn;
      }
      if (!robot.within_limits(other)) continue;
      ASSERT_LE(move.length(found - near), move.length(other - near) + 1e-9)
          << "round " << round << ", seed " << iksel_test::seed();
    }
  }
}

}  // namespace
