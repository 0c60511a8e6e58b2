// SPDX-License-Identifier: BSD-3-Clause
// Proofs by intervals: what they are calculated with, and that they deny nothing that there is.
#include <gtest/gtest.h>

#include <cmath>
#include <iksel/iksel.hpp>
#include <vector>

#include "branches.hpp"
#include "closed_chains.hpp"
#include "robots.hpp"
#include "seeds/branch_enclosure.hpp"
#include "simd/enclosed.hpp"
#include "simd/kernels.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Proof;
using iksel::Result;
using iksel::Robot;
using iksel::Solver;
using iksel_test::Dice;
using Enclosed = iksel::lanes::Enclosed<double>;

/// A number that depends on x, and its enclosure.
struct Known {
  Enclosed enclosure;
  long double number;

  [[nodiscard]] bool holds() const {
    return number >= enclosure.lower() && number <= enclosure.upper();
  }
};

Known draw(double x, Dice& dice) {
  const double value = dice.uniform(-2, 2);
  const double slope = dice.chance(0.3) ? 0 : dice.uniform(-1, 1) * std::pow(10, -dice.pick(6));
  const double radius = dice.chance(0.3) ? 0 : std::pow(10, -dice.uniform(0, 12));
  const double off = dice.chance(0.2) ? radius : dice.uniform(-1, 1) * radius;
  return {Enclosed(value, slope, radius), value + static_cast<long double>(slope) * x + off};
}

Known combine(const Known& a, const Known& b, Dice& dice) {
  const Enclosed& A = a.enclosure;
  const Enclosed& B = b.enclosure;
  switch (dice.pick(8)) {
    case 0:
      return {A + B, a.number + b.number};
    case 1:
      return {A - B, a.number - b.number};
    case 2:
      return {A * B, a.number * b.number};
    case 3: {
      const double least = std::pow(10, -dice.pick(4));
      return {A / max(B, Enclosed(least)), a.number / std::max<long double>(b.number, least)};
    }
    case 4:
      return {sqrt(max(A, Enclosed(0.0))), std::sqrt(std::max(a.number, 0.0L))};
    case 5:
      return {abs(A), std::abs(a.number)};
    case 6:
      return {min(A, B), std::min(a.number, b.number)};
    default: {
      Enclosed sine, cosine;
      sincos(A, sine, cosine);
      return dice.chance(0.5) ? Known{sine, std::sin(a.number)} : Known{cosine, std::cos(a.number)};
    }
  }
}

TEST(EnclosedNumbers, HoldWhateverIsWithinTheirErrors) {
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(20000);
  int narrow = 0;
  for (int i = 0; i < n; ++i) {
    const double x = dice.chance(0.3) ? (dice.chance(0.5) ? 1 : -1) : dice.uniform(-1, 1);
    Known known = draw(x, dice);
    for (int k = 1 + dice.pick(8); k > 0; --k) {
      const Known next = combine(known, draw(x, dice), dice);
      if (!(next.enclosure.reach() < 1e6)) break;
      known = next;
      ASSERT_TRUE(known.holds()) << static_cast<double>(known.number) << " in "
                                 << known.enclosure.lower() << " .. " << known.enclosure.upper()
                                 << ", case " << i << ", seed " << iksel_test::seed();
    }
    narrow += known.enclosure.reach() < 1e-3;
  }
  EXPECT_GE(narrow, n / 20);
}

class Enclosures : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] const Solver& solver() const { return iksel_test::solver(GetParam()); }
  [[nodiscard]] const Robot& robot() const { return solver().robot(); }
  [[nodiscard]] iksel::BranchEnclosure make_enclosure() const {
    const auto& model = robot().model();
    const auto held = model.dof == 7 ? iksel::find_closed_form(model) : iksel::find_residual(model);
    return {model, held.value(), kTolerance, kTolerance, iksel::lanes::choose_kernels()};
  }
  static constexpr double kTolerance = 1e-6;
};

/// Also at limits, where branches meet, and off by what the tolerances allow.
TEST_P(Enclosures, WhatIsReachableIsNotRuledOut) {
  iksel::BranchEnclosure enclosure = make_enclosure();
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(400);
  const Eigen::MatrixXd random = robot().random_configurations(n, iksel_test::seed() + 5);
  for (int i = 0; i < n; ++i) {
    JointVector q = random.row(i);
    if (dice.chance(0.3)) q[1 + dice.pick(robot().dof() - 2)] = dice.chance(0.5) ? 0 : 1e-5;
    if (robot().dof() == 6 && dice.chance(0.5)) {
      iksel_test::make_singular(robot(), 1 + dice.pick(4), q);
    }
    for (int k = dice.pick(3); k > 0; --k) {
      const int j = dice.pick(robot().dof());
      const double limit = dice.chance(0.5) ? robot().lower()[j] : robot().upper()[j];
      if (std::isfinite(limit)) q[j] = limit;
    }
    q = robot().model().joints.clamp(q);
    Pose target = robot().fk(q);
    const double part = dice.chance(0.5) ? 0 : 0.999 * kTolerance;
    target.translation() += part * dice.vector(1).normalized();
    target.rotate(Eigen::AngleAxisd(part, dice.vector(1).normalized()));
    EXPECT_FALSE(enclosure.rules_out(iksel_test::reduced(robot(), target)))
        << q.transpose() << ", seed " << iksel_test::seed();
  }
}

TEST_P(Enclosures, NearlyEachNoIsProvenAndNobodyRefutesIt) {
  iksel::SolveRequest proving;
  proving.prove = true;
  Dice dice(iksel_test::seed());
  const int n = iksel_test::cases(120, 60);
  const Eigen::MatrixXd random = robot().random_configurations(n, iksel_test::seed() + 6);
  int noes = 0;
  int proven = 0;
  for (int i = 0; i < n; ++i) {
    Pose target = robot().fk(random.row(i));
    target.linear() = iksel_test::rotation_of_rpy<double>(dice.vector(3.1));
    const Result result = solver().solve(target, proving);
    if (result.success()) continue;
    ++noes;
    EXPECT_EQ(solver().solve_batch({target}, proving)[0].proof, result.proof);
    EXPECT_EQ(solver().diagnose(target).proof, result.proof);
    const bool is_proven = result.proof == Proof::intervals || result.proof == Proof::closed_form ||
                           result.proof == Proof::reach;
    proven += is_proven;
    if (!is_proven || noes > 20) continue;
    EXPECT_TRUE(solver().solve_all(target).all.empty());
    EXPECT_TRUE(iksel_test::brute_force(solver(), target, 100).empty()) << i;
  }
  EXPECT_GE(noes, 5);
  EXPECT_GE(proven, noes - 1 - noes / 20);
}

INSTANTIATE_TEST_SUITE_P(Robots, Enclosures,
                         testing::Values("panda", "fr3", "xarm7", "iiwa14", "valkyrie_right_arm",
                                         "cvr038", "cvrb1213", "gen3_6dof", "xarm6"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
