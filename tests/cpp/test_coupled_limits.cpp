// SPDX-License-Identifier: BSD-3-Clause
// Laws of joint values under coupled limits, against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "base/constants.hpp"
#include "base/random.hpp"
#include "iksel/error.hpp"
#include "kinematics/chain_model.hpp"
#include "kinematics/joint_space.hpp"
#include "robots.hpp"

namespace {

using iksel::CoupledLimit;
using iksel::JointSpace;
using iksel::JointVector;
using iksel::kTwoPi;
using iksel::Limit;
using iksel::Random;
using iksel::Robot;
using iksel::RobotOptions;

/// A built-in robot under limits.
Robot bound(const std::string& name, const std::vector<CoupledLimit>& limits) {
  const Robot& from = iksel_test::robot(name);
  RobotOptions options = from.options();
  options.coupled_limits = limits;
  return Robot::from_urdf_string(from.urdf(), options);
}

std::string joint_of(const std::string& name, int joint) {
  return iksel_test::robot(name).joint_names()[static_cast<std::size_t>(joint)];
}

/// Seven joints without images, three rows.
Robot straight() {
  const auto joint = [](int i) { return joint_of("iiwa14", i); };
  return bound("iiwa14", {{{{joint(1), 1}, {joint(3), -1}}, -1.0, 2.2},
                          {{{joint(3), 0.5}, {joint(5), 1}, {joint(0), -1}}, -1.5, 1.0},
                          {{{joint(2), 2}, {joint(4), 1}}, -4.0, 3.0}});
}

/// Six joints of two whole turns each, two rows.
Robot turning() {
  const auto joint = [](int i) { return joint_of("ur10e", i); };
  return bound("ur10e", {{{{joint(1), 1}, {joint(2), 1}}, -3.0, 4.0},
                         {{{joint(3), 1}, {joint(2), -0.5}}, -2.0, 5.0}});
}

JointVector draw(const JointSpace& joints, Random& random, double beyond) {
  JointVector q(joints.dof());
  for (int j = 0; j < joints.dof(); ++j) {
    q[j] = random.uniform(joints.lower[j] - beyond, joints.upper[j] + beyond);
  }
  return q;
}

bool is_inside(const JointSpace& joints, const JointVector& q, double slack = 0) {
  for (int j = 0; j < joints.dof(); ++j) {
    if (q[j] < joints.lower[j] - slack || q[j] > joints.upper[j] + slack) return false;
  }
  return std::all_of(joints.sums.begin(), joints.sums.end(), [&](const Limit& row) {
    const double sum = row.c.dot(q);
    return sum >= row.lower - slack && sum <= row.upper + slack;
  });
}

/// Every combination of whole turns inside the limits.
std::vector<JointVector> images(const JointSpace& joints, const JointVector& q) {
  std::vector<JointVector> all{q};
  for (int j = 0; j < joints.dof(); ++j) {
    std::vector<JointVector> more;
    for (const JointVector& each : all) {
      for (int turn = -3; turn <= 3; ++turn) {
        JointVector moved = each;
        moved[j] += kTwoPi * turn;
        if (moved[j] >= joints.lower[j] && moved[j] <= joints.upper[j]) more.push_back(moved);
      }
    }
    all = more;
  }
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const JointVector& each) { return !is_inside(joints, each); }),
            all.end());
  return all;
}

TEST(CoupledLimits, WhatIsInsideIsSaid) {
  for (const Robot& robot : {straight(), turning()}) {
    const JointSpace& joints = robot.model().joints;
    Random random(iksel_test::seed());
    int inside = 0;
    for (int i = 0; i < iksel_test::cases(2000); ++i) {
      const JointVector q = draw(joints, random, 0.2);
      ASSERT_EQ(joints.contains(q.data()), is_inside(joints, q)) << "seed " << iksel_test::seed();
      inside += is_inside(joints, q) ? 1 : 0;
      ASSERT_TRUE(is_inside(joints, joints.sample(random))) << "seed " << iksel_test::seed();
    }
    EXPECT_GT(inside, 0);
    EXPECT_TRUE(is_inside(joints, joints.interior, -0.05));
  }
}

TEST(CoupledLimits, HeldIsInsideAndNotFar) {
  const Robot robot = straight();
  const JointSpace& joints = robot.model().joints;
  Random random(iksel_test::seed());
  std::vector<JointVector> others;
  for (int i = 0; i < 3000; ++i) others.push_back(joints.sample(random));
  for (int i = 0; i < iksel_test::cases(500); ++i) {
    const JointVector q = draw(joints, random, 0.5);
    const JointVector held = joints.clamp(q);
    ASSERT_TRUE(is_inside(joints, held)) << "seed " << iksel_test::seed() << ", case " << i;
    ASSERT_EQ(joints.clamp(held), held);
    if (is_inside(joints, q)) ASSERT_EQ(held, q);
    double nearest = iksel::kInfinity;
    for (const JointVector& other : others) nearest = std::min(nearest, (other - q).norm());
    // One row after the other is not the nearest of all, but not far from it.
    ASSERT_LE((held - q).norm(), 1.2 * nearest) << "seed " << iksel_test::seed() << ", case " << i;
  }
}

TEST(CoupledLimits, OneRowIsHeldToTheNearest) {
  const auto joint = [](int i) { return joint_of("iiwa14", i); };
  const Robot robot = bound("iiwa14", {{{{joint(1), 1}, {joint(3), -2}}, -0.5, 0.7}});
  const JointSpace& joints = robot.model().joints;
  const Limit& row = joints.sums.front();
  Random random(iksel_test::seed());
  for (int i = 0; i < iksel_test::cases(500); ++i) {
    const JointVector q = draw(joints, random, 0);
    const JointVector moved = joints.clamp(q) - q;
    // Along the coefficients, by equal parts of them, but for joints that came to a limit.
    double part = 0;
    for (int j = 0; j < joints.dof(); ++j) {
      if (row.c[j] != 0) part = std::max(part, std::abs(moved[j] / row.c[j]));
    }
    for (int j = 0; j < joints.dof(); ++j) {
      const double at = q[j] + moved[j];
      if (at == joints.lower[j] || at == joints.upper[j]) continue;
      EXPECT_NEAR(std::abs(moved[j]), part * std::abs(row.c[j]), 1e-9) << iksel_test::seed();
    }
  }
}

TEST(CoupledLimits, ImagesAreThoseInside) {
  const Robot robot = turning();
  const JointSpace& joints = robot.model().joints;
  Random random(iksel_test::seed());
  const auto key = [](const JointVector& at) {
    std::vector<long> rounded;
    for (const double x : at) rounded.push_back(std::lround(1e6 * x));
    return rounded;
  };
  for (int i = 0; i < iksel_test::cases(300); ++i) {
    JointVector q = joints.sample(random);
    std::set<std::vector<long>> wanted;
    for (const JointVector& each : images(joints, q)) wanted.insert(key(each));
    std::set<std::vector<long>> found;
    std::size_t count = 0;
    joints.visit_images(q, [&](const JointVector& image) {
      EXPECT_TRUE(is_inside(joints, image)) << "seed " << iksel_test::seed() << ", case " << i;
      found.insert(key(image));
      return ++count > 0;
    });
    ASSERT_EQ(found, wanted) << "seed " << iksel_test::seed() << ", case " << i;
    ASSERT_EQ(count, found.size());
  }
}

TEST(CoupledLimits, TheNearestImageIsFound) {
  const Robot robot = turning();
  const JointSpace& joints = robot.model().joints;
  Random random(iksel_test::seed());
  const JointVector weights = JointVector::LinSpaced(joints.dof(), 0.5, 3.0);
  const auto length = [&](const JointVector& d) { return d.cwiseProduct(weights).norm(); };
  for (int i = 0; i < iksel_test::cases(300); ++i) {
    JointVector q = joints.sample(random);
    const JointVector near = draw(joints, random, 0);
    double least = iksel::kInfinity;
    for (const JointVector& each : images(joints, q)) {
      least = std::min(least, length(each - near));
    }
    joints.wrap_nearest(near, 0, length, q);
    EXPECT_TRUE(is_inside(joints, q));
    ASSERT_NEAR(length(q - near), least, 1e-9) << "seed " << iksel_test::seed() << ", case " << i;
  }
}

TEST(CoupledLimits, WrappingFindsAnImageInside) {
  const Robot robot = turning();
  const JointSpace& joints = robot.model().joints;
  Random random(iksel_test::seed());
  for (int i = 0; i < iksel_test::cases(500); ++i) {
    JointVector q = joints.sample(random);
    for (int j = 0; j < joints.dof(); ++j) q[j] += kTwoPi * std::floor(random.uniform(-2, 3));
    joints.wrap(q.data());
    // Rounding of whole turns may take a joint off its limit.
    ASSERT_TRUE(is_inside(joints, q, 1e-9)) << "seed " << iksel_test::seed() << ", case " << i;
  }
}

TEST(CoupledLimits, ArmsWithoutLimitsHaveNoneCoupled) {
  const Robot free = straight().without_limits();
  EXPECT_TRUE(free.options().coupled_limits.empty());
  EXPECT_TRUE(free.within_limits(JointVector::Constant(7, 100.0)));
}

TEST(CoupledLimits, ManyImagesAreRefused) {
  const auto joint = [](int i) { return joint_of("ur10e", i); };
  const std::vector<CoupledLimit> limits{
      {{{joint(0), 1}, {joint(1), 1}, {joint(2), 1}, {joint(3), 1}}, -3.0, 4.0}};
  EXPECT_THROW(bound("ur10e", limits), iksel::InvalidArgumentError);
}

}  // namespace
