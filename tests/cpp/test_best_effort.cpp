// SPDX-License-Identifier: BSD-3-Clause
// The least error that is found stays inside the limits, whatever turns on the way.
#include <gtest/gtest.h>

#include <string>

#include "refine/best_effort.hpp"
#include "robots.hpp"

namespace {

/// Joints with more than a turn of range, one of which another follows by a part of its angle:
/// whole turns then lead elsewhere.
const char* const kFollowed = R"(<robot name="followed">
<link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
<joint name="j1" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-8" upper="8" velocity="1" effort="1"/></joint>
<joint name="j2" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 1 0"/>
<origin xyz="0.1 0 0.3"/><limit lower="-10" upper="9" velocity="1" effort="1"/></joint>
<joint name="j3" type="revolute"><parent link="c"/><child link="d"/><axis xyz="0 1 0"/>
<origin xyz="0 0 0.4"/><limit lower="-9" upper="9" velocity="1" effort="1"/>
<mimic joint="j2" multiplier="0.37"/></joint>
<joint name="j4" type="revolute"><parent link="d"/><child link="e"/><axis xyz="1 0 0"/>
<origin xyz="0 0 0.3"/><limit lower="-7" upper="7" velocity="1" effort="1"/></joint>
</robot>)";

TEST(BestEffort, EndsInsideTheLimits) {
  const iksel::Robot robot = iksel::Robot::from_urdf_string(kFollowed);
  const iksel::Matrix q = robot.random_configurations(
      static_cast<std::size_t>(iksel_test::cases(200, 50)), iksel_test::seed());
  const iksel::TaskSpace task(iksel::Task{}, 1e-6, 1e-6);
  for (Eigen::Index i = 0; i + 1 < q.rows(); ++i) {
    // Three joints cannot reach such a pose.
    iksel::Pose target = robot.fk(q.row(i));
    target.linear() = robot.fk(q.row(i + 1)).linear();
    const iksel::Goal goal(robot.model(), task, target);
    iksel::BestEffort effort(goal, 0.3);
    for (const iksel::JointVector& start : {robot.upper(), robot.lower()}) {
      const iksel::JointVector end = effort.from(start);
      EXPECT_TRUE(robot.within_limits(end)) << end.transpose() << ", case " << i;
    }
  }
}

}  // namespace
