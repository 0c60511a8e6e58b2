// SPDX-License-Identifier: BSD-3-Clause
// Six joints of which one is swept: the residual, its roots, and what is concluded from them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>

#include "branches.hpp"
#include "closed_chains.hpp"
#include "levels.hpp"
#include "robots.hpp"
#include "seeds/root_sweep.hpp"
#include "simd/kernels.hpp"
#include "structure/residual_form.hpp"

namespace {

namespace lanes = iksel::lanes;
using iksel::ClosedFormChain;
using iksel::JointVector;
using iksel::Pose;
using iksel::Proof;
using iksel::Result;
using iksel::Robot;
using iksel::RootFinder;
using iksel::RootSweep;
using iksel::Solver;
using iksel_test::AxisMaker;
using iksel_test::Dice;
using lanes::Closure;

constexpr double kTwoPi = 6.28318530717958647692;

RootSweep sweep_of(const Robot& robot) {
  return {robot.model(), *iksel::find_closed_form(robot.model()), /*is_nominal=*/true, 1e-6,
          lanes::choose_kernels()};
}

/// Whether q is among the solutions that a sweep has found.
bool holds(const RootSweep& sweep, const Robot& robot, const JointVector& q, double within) {
  for (int i = 0; i < sweep.size(); ++i) {
    const JointVector other = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(sweep.q(i));
    if (iksel_test::distance(robot, other, q) <= within) return true;
  }
  return false;
}

/// Finds all solutions of a pose.
void find(RootSweep& sweep, const Robot& robot, const Pose& target) {
  sweep.find(iksel_test::reduced(robot, target), true);
}

/// How far q is from being singular.
double least_singular_value(const Robot& robot, const JointVector& q) {
  return robot.jacobian(q).jacobiSvd().singularValues().minCoeff();
}

/// Random chains of a closure, seen from either end.
class SweptChains : public testing::TestWithParam<std::tuple<Closure, bool>> {
 protected:
  template <typename Check>
  void for_each_chain(int count, double limit, const Check& check) const {
    const auto [closure, is_reversed] = GetParam();
    int as_made = 0;
    for (int i = 0; i < count; ++i) {
      const std::uint64_t seed = iksel_test::seed() * 1000 + static_cast<std::uint64_t>(i);
      SCOPED_TRACE("chain of seed " + std::to_string(seed));
      Dice dice(seed);
      const Robot robot =
          iksel_test::make_robot(AxisMaker(dice).make(closure, is_reversed), dice, limit);
      auto chain = iksel::find_closed_form(robot.model());
      ASSERT_TRUE(chain.has_value());
      EXPECT_EQ(iksel::find_structure(robot).kind, iksel::StructureKind::swept);
      check(robot, *chain, dice);
      as_made += chain->form.closure == closure && chain->reversed == is_reversed;
    }
    // Axes may meet by chance too.
    EXPECT_GE(as_made, count * 9 / 10);
  }
};

/// Of the residual by its definition: where a branch has none, it has none.
TEST_P(SweptChains, TheResidualIsZeroAtSolutions) {
  for_each_chain(
      iksel_test::cases(40), 0, [](const Robot& robot, const ClosedFormChain& chain, Dice&) {
        const Eigen::MatrixXd random = robot.random_configurations(10, iksel_test::seed());
        const auto held = static_cast<std::size_t>(chain.held);
        auto pack = iksel::all_branches();
        for (int i = 0; i < random.rows(); ++i) {
          chain.set_target(iksel_test::reduced(robot, robot.fk(random.row(i))), pack);
          const lanes::ResidualForm form = iksel::make_residual(chain, pack);
          std::array<double, 128> angles;
          std::array<double, 128> residuals;
          const double at = random(i, chain.held) + robot.model().kernel.joints[held].offset;
          for (std::size_t k = 0; k < 128; ++k)
            angles[k] = at + kTwoPi / 128 * static_cast<double>(k);
          lanes::choose_kernels().find_residuals(form, angles.data(), 128, residuals.data());
          double largest = 0;
          for (const double r : residuals) largest = std::max(largest, std::abs(r));
          EXPECT_LE(std::abs(residuals[0]), 1e-9 * largest) << random.row(i);
          EXPECT_GT(largest, 0);
        }
      });
}

TEST_P(SweptChains, HoldsTheSolutionThatWasPutIn) {
  int all = 0;
  int lost = 0;
  for_each_chain(
      iksel_test::cases(40), 3.0, [&](const Robot& robot, const ClosedFormChain&, Dice&) {
        RootSweep sweep = sweep_of(robot);
        const Eigen::MatrixXd random = robot.random_configurations(20, iksel_test::seed());
        for (int i = 0; i < random.rows(); ++i) {
          const JointVector q = random.row(i);
          find(sweep, robot, robot.fk(q));
          for (int k = 0; k < sweep.size(); ++k) {
            EXPECT_LE(Eigen::Map<const JointVector>(sweep.q(k), 6).cwiseAbs().maxCoeff(), 3.1);
          }
          if (least_singular_value(robot, q) < 1e-4) continue;
          ++all;
          // Where two branches meet, roots are double, and a seed is near to the solution.
          lost += !holds(sweep, robot, q, 0.1);
        }
      });
  EXPECT_LE(lost, all / 20000) << "of " << all;
}

TEST_P(SweptChains, EveryLevelFindsTheSameRoots) {
  for_each_chain(
      iksel_test::cases(5), 0, [](const Robot& robot, const ClosedFormChain& chain, Dice&) {
        auto pack = iksel::all_branches();
        chain.set_target(iksel_test::reduced(robot, robot.fk(JointVector::Constant(6, 0.7))), pack);
        const lanes::ResidualForm form = iksel::make_residual(chain, pack);
        RootFinder reference(0, kTwoPi, 1e-3, lanes::choose_kernels());
        reference.find(form);
        for (const std::string& level : iksel_test::levels()) {
          const iksel_test::ForcedLevel forced(level);
          RootFinder other(0, kTwoPi, 1e-3, lanes::choose_kernels());
          other.find(form);
          ASSERT_EQ(other.size(), reference.size()) << level;
          for (std::size_t i = 0; i < other.size(); ++i) {
            EXPECT_NEAR(other[i].angle, reference[i].angle, 1e-7) << level;
          }
        }
      });
}

INSTANTIATE_TEST_SUITE_P(Each, SweptChains,
                         testing::Combine(testing::Values(Closure::sweep_4, Closure::sweep_6),
                                          testing::Bool()));

class RootSweeps : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] const Solver& solver() const { return iksel_test::solver(GetParam()); }
  [[nodiscard]] const Robot& robot() const { return solver().robot(); }
};

TEST_P(RootSweeps, SolutionsAreThoseOfManySeeds) {
  iksel_test::Judge judge(robot());
  const int n = iksel_test::cases(15);
  const Eigen::MatrixXd random = robot().random_configurations(n, iksel_test::seed());
  int concluded = 0;
  int missed = 0;
  for (int i = 0; i < n; ++i) {
    const Pose target = robot().fk(random.row(i));
    const iksel::Solutions all = solver().solve_all(target);
    concluded += all.proof == Proof::sweep;
    for (const Result& result : all.all) judge.expect_solution(target, result.q);
    auto known = iksel_test::brute_force(solver(), target, 300);
    known.emplace_back(random.row(i));
    for (const JointVector& q : known) {
      if (least_singular_value(robot(), q) < 1e-3) continue;
      missed += std::none_of(all.all.begin(), all.all.end(), [&](const Result& result) {
        return iksel_test::distance(robot(), result.q, q) < 0.02;
      });
    }
  }
  EXPECT_LE(missed, n / 500) << "seed " << iksel_test::seed();
  EXPECT_GE(concluded, n * 9 / 10);
}

/// Solutions at limits, and where two of them meet.
TEST_P(RootSweeps, WhatIsReachableIsNotSaidToHaveNoSolution) {
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(300);
  const Eigen::MatrixXd random = robot().random_configurations(n, iksel_test::seed() + 3);
  int unsolved = 0;
  for (int i = 0; i < n; ++i) {
    JointVector q = random.row(i);
    for (int k = dice.pick(4); k > 0; --k) {
      const int j = dice.pick(6);
      const double limit = dice.chance(0.5) ? robot().lower()[j] : robot().upper()[j];
      if (std::isfinite(limit)) q[j] = limit;
    }
    if (dice.chance(0.5)) iksel_test::make_singular(robot(), 1 + dice.pick(4), q);
    const Result result = solver().solve(robot().fk(q));
    unsolved += !result.success();
    EXPECT_EQ(result.proof, Proof::none) << q.transpose() << ", seed " << iksel_test::seed();
  }
  EXPECT_LE(unsolved, n / 100);
}

TEST_P(RootSweeps, NoOneElseSolvesWhatHasNone) {
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(60, 20);
  const Eigen::MatrixXd random = robot().random_configurations(n, iksel_test::seed());
  int none = 0;
  for (int i = 0; i < n; ++i) {
    Pose target = robot().fk(random.row(i));
    target.linear() = iksel_test::rotation_of_rpy<double>(dice.vector(3.1));
    const Result result = solver().solve(target);
    EXPECT_NE(result.proof, Proof::closed_form);
    if (result.proof != Proof::sweep) continue;
    ++none;
    EXPECT_EQ(solver().solve_batch({target})[0].proof, Proof::sweep);
    EXPECT_EQ(solver().solve_all(target).proof, Proof::sweep);
    EXPECT_TRUE(iksel_test::brute_force(solver(), target, 200).empty()) << i;
  }
  EXPECT_GE(none, 1);
}

TEST_P(RootSweeps, LargeTolerancesAreAllowedFor) {
  iksel::SolverOptions options;
  options.position_tolerance = 0.03;
  options.rotation_tolerance = 0.1;
  const Solver rough(robot(), options);
  Dice dice(iksel_test::seed());
  const Eigen::MatrixXd random =
      robot().random_configurations(iksel_test::cases(100), iksel_test::seed());
  for (int i = 0; i < random.rows(); ++i) {
    const Pose target = iksel_test::shifted(robot().fk(random.row(i)), 0.029, 0.099, dice);
    EXPECT_EQ(rough.solve(target).proof, Proof::none) << random.row(i);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, RootSweeps,
                         testing::Values("cvr038", "cvrb1213", "gen3_6dof", "xarm6"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
