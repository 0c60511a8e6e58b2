// SPDX-License-Identifier: BSD-3-Clause
// Several tips at once, against the forward kinematics of each chain by KDL, finite differences,
// and the chains' own solvers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>

#include "robots.hpp"
#include "trees.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Proof;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel::SolveRequest;
using iksel::Status;
using iksel::Task;
using iksel_test::joint_text;
using iksel_test::mounted;
using iksel_test::robot_text;
using iksel_test::tips_of;
using iksel_test::two_armed;

JointVector row_of(const iksel::Matrix& q, int i) { return q.row(i).transpose(); }

/// Expects q to put each tip at its target by KDL's kinematics of its chain, inside all limits.
void expect_answer(const Robot& robot, const std::vector<Pose>& targets, const JointVector& q,
                   const std::vector<Task>& tasks = {}) {
  EXPECT_TRUE(robot.within_limits(q));
  for (int i = 0; i < robot.tips(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    JointVector of_chain(robot.chain(i).dof());
    for (int j = 0; j < of_chain.size(); ++j) {
      of_chain[j] = q[robot.joints_of(i)[static_cast<std::size_t>(j)]];
    }
    iksel::SolverOptions options;
    if (!tasks.empty()) options.task = tasks[k];
    iksel_test::Judge(robot.chain(i)).expect_solution(targets[k], of_chain, options);
  }
}

/// Solves targets of random configurations, each of which is judged; how many are not solved.
int count_lost(const Solver& solver, int n, const SolveRequest& request = {}) {
  const Robot& robot = solver.robot();
  const iksel::Matrix q =
      robot.random_configurations(static_cast<std::size_t>(n), iksel_test::seed());
  int lost = 0;
  for (int i = 0; i < n; ++i) {
    const std::vector<Pose> targets = robot.tip_poses(row_of(q, i));
    const Result result = solver.solve(targets, request);
    lost += result.success() ? 0 : 1;
    if (result.success()) expect_answer(robot, targets, result.q, request.tasks);
  }
  return lost;
}

class TwoArmsOnATorso : public testing::TestWithParam<std::string> {};

TEST_P(TwoArmsOnATorso, ReachableTargetsAreSolved) {
  const Solver solver(two_armed(iksel_test::robot(GetParam())));
  const int n = iksel_test::cases(300, 30);
  EXPECT_EQ(count_lost(solver, n), 0) << "of " << n << ", seed " << iksel_test::seed();
}

INSTANTIATE_TEST_SUITE_P(Arms, TwoArmsOnATorso,
                         testing::Values("ur5e", "panda", "pr2_right_arm", "xarm5"),
                         iksel_test::name_of);

TEST(TipsRobot, NamesTheUnionOfTheChains) {
  const Robot robot = two_armed(iksel_test::robot("ur5e"));
  EXPECT_EQ(robot.dof(), 14);
  EXPECT_EQ(robot.joint_names()[0], "lift");
  EXPECT_EQ(robot.joint_names()[1], "turn");
  EXPECT_EQ(robot.joint_names()[2], "l_shoulder_pan_joint");
  EXPECT_EQ(robot.joint_names()[8], "r_shoulder_pan_joint");
  EXPECT_EQ(robot.shared_joints(), (std::vector<int>{0, 1}));
  EXPECT_EQ(robot.joints_of(1), (std::vector<int>{0, 1, 8, 9, 10, 11, 12, 13}));
}

TEST(TipsRobot, JacobianIsTheDifferenceQuotient) {
  const Robot robot = two_armed(iksel_test::robot("panda"));
  const iksel::Matrix q = robot.random_configurations(10, iksel_test::seed());
  constexpr double kStep = 1e-6;
  for (int i = 0; i < q.rows(); ++i) {
    const iksel::Matrix J = robot.tip_jacobians(row_of(q, i));
    for (int j = 0; j < robot.dof(); ++j) {
      JointVector low = row_of(q, i);
      JointVector high = low;
      low[j] -= kStep;
      high[j] += kStep;
      const std::vector<Pose> from = robot.tip_poses(low);
      const std::vector<Pose> to = robot.tip_poses(high);
      for (std::size_t tip = 0; tip < from.size(); ++tip) {
        const Eigen::Matrix<double, 6, 1> quotient =
            iksel::pose_error(to[tip], from[tip]) / (2 * kStep);
        EXPECT_LE((quotient - J.block<6, 1>(6 * static_cast<int>(tip), j)).norm(), 1e-7);
      }
    }
  }
}

TEST(TipsSolver, LegsWithoutSharedJointsAreSolvedEachByItself) {
  const iksel::Robot& leg = iksel_test::robot("ur5e");
  std::string inside;
  std::vector<std::string> tips;
  for (const char* name : {"a_", "b_", "c_"}) {
    inside += mounted(leg, name, "base", "xyz=\"0 " + std::to_string(tips.size()) + " 1\"");
    tips.push_back(name + leg.tip_link());
  }
  const Solver solver(Robot::from_urdf_string(robot_text(inside), tips_of(tips)));
  EXPECT_TRUE(solver.robot().shared_joints().empty());
  EXPECT_EQ(count_lost(solver, 50), 0);

  // A leg that certainly cannot be reached proves that all cannot.
  std::vector<Pose> targets = solver.robot().tip_poses(JointVector::Constant(18, 0.5));
  targets[1] = targets[1] * Pose(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  targets[1].translation() = Eigen::Vector3d(0, 1, 1 + 0.1625);
  const Result result = solver.solve(targets);
  EXPECT_FALSE(result.success());
  EXPECT_EQ(result.unreachable_tip, 1);
  EXPECT_EQ(result.proof, solver.chain_solver(1).solve(targets[1]).proof);
}

/// A torso that turns, and two arms of so many joints; all in a plane.
Robot planar(int joints) {
  std::string inside = joint_text("turn", "base", "revolute", "xyz=\"0 0 0\"");
  std::vector<std::string> tips;
  for (const std::string side : {"l", "r"}) {
    std::string parent = "turn_link";
    for (int j = 0; j < joints; ++j) {
      const std::string origin = j > 0 ? "0.4 0" : side == "l" ? "0.1 0.3" : "0.1 -0.3";
      inside +=
          joint_text(side + std::to_string(j), parent, "revolute", "xyz=\"" + origin + " 0\"");
      parent = side + std::to_string(j) + "_link";
    }
    inside += joint_text(side + "_end", parent, "fixed", "xyz=\"0.3 0 0\"");
    tips.push_back(side + "_end_link");
  }
  return Robot::from_urdf_string(robot_text(inside), tips_of(tips));
}

TEST(TipsSolver, PlanarArmsReachTheirPlanarTasks) {
  SolveRequest request;
  request.tasks.assign(2, Task::planar());
  EXPECT_EQ(count_lost(Solver(planar(3)), 300, request), 0) << "seed " << iksel_test::seed();
}

TEST(TipsSolver, ArmsWithFewerJointsThanTheirTaskMoveTheTorsoTogether) {
  SolveRequest request;
  request.tasks = {Task::planar(), Task::position_only()};
  const Solver solver(planar(2));
  EXPECT_EQ(count_lost(solver, 300, request), 0) << "seed " << iksel_test::seed();
}

TEST(TipsSolver, TasksMayDifferAndLieAlongTheBase) {
  const Solver solver(two_armed(iksel_test::robot("panda")));
  SolveRequest request;
  request.tasks = {Task::upright(), Task::free_spin()};
  EXPECT_EQ(count_lost(solver, 100, request), 0) << "seed " << iksel_test::seed();
  request.tasks = {Task::position_only(), Task::pose()};
  EXPECT_EQ(count_lost(solver, 100, request), 0) << "seed " << iksel_test::seed();
}

TEST(TipsSolver, OneTipMayLieOnTheChainOfAnother) {
  const Robot& arm = iksel_test::robot("panda");
  const Solver solver(Robot::from_urdf_string(arm.urdf(), tips_of({"panda_link4", "panda_link8"})));
  EXPECT_EQ(solver.robot().dof(), 7);
  SolveRequest request;
  request.tasks = {Task::position_only(), Task::pose()};
  EXPECT_EQ(count_lost(solver, 200, request), 0) << "seed " << iksel_test::seed();
}

TEST(TipsSolver, JointsMayMimicAcrossTheArms) {
  // The last joint of the right arm follows the torso, so that it is no chain by itself.
  std::string inside = joint_text("turn", "base", "revolute", "xyz=\"0 0 0\"");
  inside += mounted(iksel_test::robot("ur5e"), "l_", "turn_link", "xyz=\"0 0.3 0\"");
  inside += mounted(iksel_test::robot("ur5e"), "r_", "turn_link", "xyz=\"0 -0.3 0\"");
  inside += joint_text("wrist", "r_tool0", "revolute", "xyz=\"0 0 0.1\"", "1 0 0",
                       "lower=\"-1\" upper=\"1\"", "<mimic joint=\"turn\" multiplier=\"0.8\"/>");
  const Solver solver(
      Robot::from_urdf_string(robot_text(inside), tips_of({"l_tool0", "wrist_link"})));
  EXPECT_EQ(solver.robot().dof(), 13);
  // Only the right chain knows that its follower narrows the torso's limits.
  EXPECT_DOUBLE_EQ(solver.robot().upper()[0], 1.25);
  EXPECT_EQ(count_lost(solver, 100), 0) << "seed " << iksel_test::seed();
}

TEST(TipsSolver, SharedJointsMayTurnFreely) {
  const Robot& arm = iksel_test::robot("ur5e");
  const std::string inside = joint_text("turn", "base", "continuous", "xyz=\"0 0 0\"") +
                             mounted(arm, "l_", "turn_link", "xyz=\"0 0.3 0\"") +
                             mounted(arm, "r_", "turn_link", "xyz=\"0 -0.3 0\"");
  const Solver solver(Robot::from_urdf_string(robot_text(inside), tips_of({"l_tool0", "r_tool0"})));
  EXPECT_EQ(count_lost(solver, 100), 0) << "seed " << iksel_test::seed();
}

TEST(TipsSolver, ToolsAreMetAndOneTipIsAChain) {
  const Robot& arm = iksel_test::robot("ur5e");
  iksel::RobotOptions options = tips_of({arm.tip_link()});
  options.tcps.emplace_back(Eigen::Translation3d(0.1, 0, 0.2));
  const Solver solver(Robot::from_urdf_string(arm.urdf(), options));
  EXPECT_EQ(count_lost(solver, 100), 0) << "seed " << iksel_test::seed();
  const JointVector q = row_of(solver.robot().random_configurations(1, 3), 0);
  EXPECT_TRUE(solver.robot().tip_poses(q)[0].isApprox(arm.fk(q) * Pose(options.tcps[0]), 1e-12));
}

TEST(TipsSolver, NearIsTheAnswerWhereItIsOne) {
  for (const char* name : {"ur5e", "panda"}) {
    const Solver solver(two_armed(iksel_test::robot(name)));
    const iksel::Matrix q = solver.robot().random_configurations(50, iksel_test::seed());
    for (int i = 0; i < q.rows(); ++i) {
      SolveRequest request;
      request.near = row_of(q, i);
      const Result result = solver.solve(solver.robot().tip_poses(row_of(q, i)), request);
      ASSERT_TRUE(result.success()) << name;
      EXPECT_LE(result.move, 1e-9) << name;
      EXPECT_LE((result.q - row_of(q, i)).norm(), 1e-9) << name;
    }
  }
}

TEST(TipsSolver, NearIsAsNearAsTheConfigurationThatIsKnown) {
  for (const iksel::MoveNorm norm : {iksel::MoveNorm::two, iksel::MoveNorm::max}) {
    const Solver solver(two_armed(iksel_test::robot("panda")));
    const int n = iksel_test::cases(60, 20);
    const auto count = static_cast<std::size_t>(n);
    const iksel::Matrix q = solver.robot().random_configurations(count, iksel_test::seed());
    const iksel::Matrix to = solver.robot().random_configurations(count, iksel_test::seed() + 1);
    int farther = 0;
    for (int i = 0; i < n; ++i) {
      const JointVector from = row_of(q, i);
      const JointVector change = row_of(to, i) - from;
      SolveRequest request;
      request.near = from + 0.1 * change;
      request.norm = norm;
      const std::vector<Pose> targets = solver.robot().tip_poses(from);
      const Result result = solver.solve(targets, request);
      ASSERT_TRUE(result.success());
      expect_answer(solver.robot(), targets, result.q);
      const double known =
          0.1 * (norm == iksel::MoveNorm::two ? change.norm() : change.cwiseAbs().maxCoeff());
      farther += result.move > known + 1e-6;
    }
    EXPECT_LE(farther, n / 20) << "of " << n << ", seed " << iksel_test::seed();
  }
}

TEST(TipsSolver, SaysWhichTipCannotBeReached) {
  const Solver solver(two_armed(iksel_test::robot("ur5e")));
  const JointVector q = row_of(solver.robot().random_configurations(1, iksel_test::seed()), 0);
  std::vector<Pose> targets = solver.robot().tip_poses(q);
  targets[1].translation().x() += 10;
  const Result far = solver.solve(targets);
  EXPECT_EQ(far.status, Status::out_of_reach);
  EXPECT_EQ(far.proof, Proof::reach);
  EXPECT_EQ(far.unreachable_tip, 1);
  EXPECT_EQ(far.q.size(), 0);
  const iksel::Diagnosis why = solver.diagnose(targets);
  EXPECT_EQ(why.unreachable_tip, 1);
  EXPECT_EQ(why.cause, iksel::Cause::out_of_reach);
  EXPECT_EQ(why.q.size(), solver.robot().chain(1).dof());
  EXPECT_NE(why.message.find("r_tool0"), std::string::npos) << why.message;
}

TEST(TipsSolver, SaysThatOnlyBothTogetherCannotBeReached) {
  // Stretched away from the torso's axis, a hand leaves the torso one angle only: here two.
  const Solver solver(planar(3));
  const Robot& robot = solver.robot();
  JointVector left = JointVector::Zero(robot.dof());
  JointVector right = left;
  left[0] = 0.8;
  left[1] = std::atan2(0.3, 0.1);
  right[0] = -0.8;
  right[4] = -std::atan2(0.3, 0.1);
  const std::vector<Pose> torn = {robot.tip_poses(left)[0], robot.tip_poses(right)[1]};
  SolveRequest request;
  request.tasks.assign(2, Task::planar());
  const Result result = solver.solve(torn, request);
  EXPECT_EQ(result.status, Status::not_converged);
  EXPECT_EQ(result.proof, Proof::none);
  EXPECT_EQ(result.unreachable_tip, -1);
  const iksel::Diagnosis why = solver.diagnose(torn, request);
  EXPECT_EQ(why.unreachable_tip, -1);
  EXPECT_EQ(why.cause, iksel::Cause::shared_joints);
  EXPECT_NE(why.message.find("turn"), std::string::npos) << why.message;
  EXPECT_TRUE(solver.solve(robot.tip_poses(left), request).success());
  EXPECT_TRUE(solver.solve(robot.tip_poses(right), request).success());
}

TEST(TipsSolver, BatchIsTheLoopOnAnyNumberOfThreads) {
  const Solver solver(two_armed(iksel_test::robot("panda")));
  const Robot& robot = solver.robot();
  constexpr int kTargets = 60;
  const iksel::Matrix q = robot.random_configurations(kTargets, iksel_test::seed());
  std::vector<Pose> all;
  for (int i = 0; i < kTargets; ++i) {
    for (const Pose& pose : robot.tip_poses(row_of(q, i))) all.push_back(pose);
  }
  all[7].linear() *= 2;  // no pose
  for (const bool with_near : {false, true}) {
    SolveRequest request;
    std::vector<JointVector> near;
    for (int i = 0; with_near && i < kTargets; ++i)
      near.emplace_back(row_of(q, (i + 1) % kTargets));
    for (const int threads : {1, 3}) {
      const std::vector<Result> batch = solver.solve_batch(all, request, near, threads);
      ASSERT_EQ(batch.size(), kTargets);
      for (int i = 0; i < kTargets; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (i == 3) {
          EXPECT_EQ(batch[k].status, Status::invalid_pose);
          continue;
        }
        if (with_near) request.near = near[k];
        const Result one = solver.solve({all[2 * k], all[2 * k + 1]}, request);
        ASSERT_EQ(batch[k].status, one.status);
        EXPECT_EQ(batch[k].q, one.q);
        EXPECT_EQ(batch[k].position_error, one.position_error);
      }
    }
  }
}

TEST(TipsSolver, FilterAndDeadlineAreKept) {
  const Solver solver(two_armed(iksel_test::robot("ur5e")));
  const Robot& robot = solver.robot();
  const JointVector q = row_of(robot.random_configurations(1, iksel_test::seed()), 0);
  SolveRequest request;
  const double lift = solver.solve(robot.tip_poses(q)).q[0];
  request.filter = iksel::filter_each(
      robot.dof(), [&](const JointVector& c) { return std::abs(c[0] - lift) > 0.01; });
  const Result other = solver.solve(robot.tip_poses(q), request);
  ASSERT_TRUE(other.success());
  EXPECT_GT(std::abs(other.q[0] - lift), 0.01);
  request.filter = iksel::filter_each(robot.dof(), [](const JointVector&) { return false; });
  EXPECT_EQ(solver.solve(robot.tip_poses(q), request).status, Status::rejected);
  request.filter = {};
  request.deadline = 1e-9;
  EXPECT_EQ(solver.solve(robot.tip_poses(q), request).status, Status::out_of_time);
}

/// Whenever time is over, what was found until then is the answer.
TEST(TipsSolver, WhatWasFoundInTimeIsKept) {
  const Solver solver(two_armed(iksel_test::robot("panda")));
  const Robot& robot = solver.robot();
  const iksel::Matrix q = robot.random_configurations(20, iksel_test::seed());
  for (int i = 0; i < q.rows(); ++i) {
    SolveRequest request;
    request.near = row_of(q, (i + 1) % static_cast<int>(q.rows()));
    request.deadline = std::pow(10.0, -6 + 0.2 * i);
    const std::vector<Pose> targets = robot.tip_poses(row_of(q, i));
    const Result result = solver.solve(targets, request);
    EXPECT_EQ(result.success(), result.q.size() > 0) << request.deadline;
    if (result.success()) expect_answer(robot, targets, result.q);
  }
}

TEST(TipsSolver, NearIsLookedForWhereArmsAreShort) {
  const Solver solver(two_armed(iksel_test::robot("xarm5")));
  const int n = iksel_test::cases(60, 20);
  const auto count = static_cast<std::size_t>(n);
  const iksel::Matrix q = solver.robot().random_configurations(count, iksel_test::seed());
  const iksel::Matrix from = solver.robot().random_configurations(count, iksel_test::seed() + 1);
  int farther = 0;
  for (int i = 0; i < n; ++i) {
    SolveRequest request;
    request.near = row_of(from, i);
    const std::vector<Pose> targets = solver.robot().tip_poses(row_of(q, i));
    const Result result = solver.solve(targets, request);
    ASSERT_TRUE(result.success());
    expect_answer(solver.robot(), targets, result.q);
    farther += result.move > (q.row(i) - from.row(i)).norm() + 1e-6;
  }
  EXPECT_LE(farther, n / 20) << "of " << n << ", seed " << iksel_test::seed();
}

template <typename Error>
std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(TipsRobot, ErrorsNameTheCulprit) {
  const std::string urdf = iksel_test::two_arms_on_torso(iksel_test::robot("ur5e"));
  const auto made = [&](const iksel::RobotOptions& options) {
    return [&urdf, options] { Robot::from_urdf_string(urdf, options); };
  };
  using iksel::InvalidArgumentError;
  EXPECT_NE(
      message_of<iksel::UnknownNameError>(made(tips_of({"l_tool0", "r_tol0"}))).find("r_tool0"),
      std::string::npos);
  EXPECT_NE(message_of<InvalidArgumentError>(made(tips_of({"l_tool0", "l_tool0"}))).find("[1]"),
            std::string::npos);
  iksel::RobotOptions tools = tips_of({"l_tool0", "r_tool0"});
  tools.tcps.emplace_back(Pose::Identity());
  EXPECT_NE(message_of<InvalidArgumentError>(made(tools)).find("tcps"), std::string::npos);
  EXPECT_NE(message_of<InvalidArgumentError>(made(tips_of(std::vector<std::string>(9, "x"))))
                .find("at most 8"),
            std::string::npos);

  const Solver solver(Robot::from_urdf_string(urdf, tips_of({"l_tool0", "r_tool0"})));
  const auto solving = [&](const std::vector<Pose>& poses, const SolveRequest& request) {
    return [&solver, poses, request] { static_cast<void>(solver.solve(poses, request)); };
  };
  EXPECT_NE(message_of<InvalidArgumentError>(solving({Pose::Identity()}, {})).find("l_tool0"),
            std::string::npos);
  SolveRequest request;
  request.tasks.resize(3);
  const std::vector<Pose> two(2, Pose::Identity());
  EXPECT_NE(message_of<InvalidArgumentError>(solving(two, request)).find("tasks"),
            std::string::npos);
  request.tasks.clear();
  request.near = JointVector::Zero(3);
  EXPECT_NE(message_of<InvalidArgumentError>(solving(two, request)).find("near"),
            std::string::npos);
  EXPECT_NE(message_of<InvalidArgumentError>([&] {
              static_cast<void>(solver.robot().chain(2));
            }).find("r_tool0"),
            std::string::npos);
}

}  // namespace
