// SPDX-License-Identifier: BSD-3-Clause
// Closed forms of chains of three to five joints, and of tasks that leave rotations free.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <string>

#include "branches.hpp"
#include "closed_chains.hpp"
#include "robots.hpp"

namespace {

using iksel::Axis;
using iksel::JointVector;
using iksel::Pose;
using iksel::Proof;
using iksel::Robot;
using iksel::Solver;
using iksel::StructureKind;
using iksel::Task;
using iksel_test::AxisChain;
using iksel_test::Closure;
using iksel_test::Dice;

constexpr double kLimit = 2.5;
/// Of the search that is the oracle of a no.
constexpr int kManySeeds = 200;

/// The first so many axes of a random chain of six of that class.
AxisChain first_axes(Closure closure, std::size_t joints, Dice& dice) {
  AxisChain axes = iksel_test::AxisMaker(dice).make(closure, /*reversed=*/false);
  axes.h.resize(joints);
  axes.p.resize(joints);
  return axes;
}

/// An arm with them, and with a tool in any direction.
Robot random_arm(Closure closure, std::size_t joints, Dice& dice) {
  return iksel_test::make_robot(first_axes(closure, joints, dice), dice, kLimit);
}

iksel::SolverOptions options_of(const Task& task) {
  iksel::SolverOptions options;
  options.task = task;
  options.database.samples = 2000;
  return options;
}

/// Whether the search from given seeds alone, which knows no closed form, finds an answer.
bool is_found_by_search(const Solver& solver, const Pose& target, Dice& dice) {
  iksel::SolveRequest request;
  request.database_seeds = false;
  const Eigen::MatrixXd seeds = solver.robot().random_configurations(
      kManySeeds, static_cast<std::uint64_t>(dice.pick(1 << 20)));
  for (int i = 0; i < kManySeeds; ++i) request.seeds.emplace_back(seeds.row(i));
  return solver.solve(target, request).success();
}

/// Poses of the arm are solved, others are refused with a proof that a search does not refute.
void expect_sure(const Solver& solver, Dice& dice, int count) {
  const Robot& robot = solver.robot();
  const Eigen::MatrixXd q =
      robot.random_configurations(count, static_cast<std::uint64_t>(dice.pick(1 << 20)));
  int proven = 0;
  for (int i = 0; i < count; ++i) {
    const Pose target = robot.fk(q.row(i));
    EXPECT_TRUE(solver.solve(target).success()) << q.row(i);
    Pose other = target;
    other.translation() += dice.vector(0.3);
    other.linear() = iksel_test::rotation_of_rpy<double>(dice.vector(3.1));
    iksel::Result result = solver.solve(other);
    if (result.proof == Proof::reach) {
      // Off in what no joint moves: then what joints would have to leave their limits for.
      other = robot.fk(2 * q.row(i));
      result = solver.solve(other);
    }
    if (result.success()) continue;
    if (result.proof != Proof::closed_form) continue;
    ++proven;
    EXPECT_FALSE(is_found_by_search(solver, other, dice)) << q.row(i);
  }
  EXPECT_GT(proven, 0);
}

class FewJoints : public testing::TestWithParam<std::tuple<Closure, int>> {};

TEST_P(FewJoints, PosesAreSolvedOrProvenToHaveNoAnswer) {
  const auto [closure, joints] = GetParam();
  for (int i = 0; i < iksel_test::cases(6, 3); ++i) {
    const std::uint64_t seed = iksel_test::seed() * 100 + static_cast<std::uint64_t>(i);
    SCOPED_TRACE("arm of seed " + std::to_string(seed));
    Dice dice(seed);
    const Robot robot = random_arm(closure, static_cast<std::size_t>(joints), dice);
    const iksel::Structure structure = iksel::find_structure(robot);
    EXPECT_EQ(structure.kind, StructureKind::closed_form) << structure.description;
    EXPECT_NE(structure.description.find(std::to_string(joints) + " joints"), std::string::npos);
    expect_sure(Solver(robot, options_of(Task::pose())), dice, 30);
  }
}

TEST_P(FewJoints, AllSolutionsAreThoseOfManySeeds) {
  const auto [closure, joints] = GetParam();
  Dice dice(iksel_test::seed());
  const Robot robot = random_arm(closure, static_cast<std::size_t>(joints), dice);
  const Solver solver(robot, options_of(Task::pose()));
  const Eigen::MatrixXd q = robot.random_configurations(40, iksel_test::seed());
  int known = 0;
  for (int i = 0; i < q.rows(); ++i) {
    const iksel::Solutions solutions = solver.solve_all(robot.fk(q.row(i)));
    known += std::any_of(solutions.all.begin(), solutions.all.end(), [&](const auto& result) {
      return iksel_test::distance(robot, result.q, q.row(i)) < 1e-3;
    });
  }
  EXPECT_EQ(known, q.rows());
}

INSTANTIATE_TEST_SUITE_P(
    OfEveryKind, FewJoints,
    testing::Values(std::tuple(Closure::three_parallel, 5), std::tuple(Closure::three_parallel, 4),
                    std::tuple(Closure::parallel_23, 5), std::tuple(Closure::parallel_23, 4),
                    std::tuple(Closure::parallel_23, 3), std::tuple(Closure::intersect_12, 5),
                    std::tuple(Closure::intersect_12, 4), std::tuple(Closure::intersect_12, 3),
                    std::tuple(Closure::intersect_23, 4), std::tuple(Closure::parallel_12, 4)));

/// The same arm with a TCP on its last axis, turned in some way.
Robot with_tcp_on_axis(const Robot& robot, const AxisChain& axes, Dice& dice) {
  const Robot plain = robot.with_tcp(Pose::Identity());
  Pose wanted = Pose::Identity();
  wanted.translation() = axes.p.back() + 0.1 * axes.h.back();
  wanted.linear() = iksel_test::rotation_of_rpy<double>(dice.vector(3.1));
  return robot.with_tcp(plain.fk(JointVector::Zero(robot.dof())).inverse() * wanted);
}

TEST(FreeRotations, ASpinAboutAnyOtherAxisIsASixthJoint) {
  for (int i = 0; i < iksel_test::cases(6, 3); ++i) {
    Dice dice(iksel_test::seed() + static_cast<std::uint64_t>(i));
    const AxisChain axes = first_axes(Closure::three_parallel, 5, dice);
    const Robot robot = with_tcp_on_axis(iksel_test::make_robot(axes, dice, kLimit), axes, dice);
    const Task task = Task::free_spin(static_cast<Axis>(i % 3));
    const auto chain = iksel::find_closed_form(robot.model(), task);
    ASSERT_TRUE(chain.has_value());
    EXPECT_FALSE(chain->has_families());
    expect_sure(Solver(robot, options_of(task)), dice, 50);
  }
}

/// Arms whose last axis is the tool's z: its spin is the last joint's.
TEST(FreeRotations, ASpinOfTheLastJointIsSolvedOrProven) {
  for (const char* name : {"ur5e", "irb120", "xarm5"}) {
    SCOPED_TRACE(name);
    const Robot robot = iksel_test::robot(name);
    const auto chain = iksel::find_closed_form(robot.model(), Task::free_spin());
    ASSERT_TRUE(chain.has_value());
    EXPECT_TRUE(chain->has_families());
    Dice dice(iksel_test::seed());
    expect_sure(Solver(robot, options_of(Task::free_spin())), dice, 100);
  }
}

TEST(FreeRotations, ThreeJointsReachPositions) {
  for (int i = 0; i < iksel_test::cases(6, 3); ++i) {
    Dice dice(iksel_test::seed() + static_cast<std::uint64_t>(i));
    const Robot robot = random_arm(Closure::parallel_23, 3, dice);
    const auto chain = iksel::find_closed_form(robot.model(), Task::position_only());
    ASSERT_TRUE(chain.has_value());
    EXPECT_FALSE(chain->has_families());
    expect_sure(Solver(robot, options_of(Task::position_only())), dice, 50);
  }
}

}  // namespace
