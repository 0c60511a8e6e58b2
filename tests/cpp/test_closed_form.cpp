// SPDX-License-Identifier: BSD-3-Clause
// Closed forms of six joints: their branches by themselves, on random chains of every class.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iksel/iksel.hpp>
#include <limits>

#include "base/pseudo_inverse.hpp"
#include "branches.hpp"
#include "closed_chains.hpp"
#include "levels.hpp"
#include "robots.hpp"
#include "seeds/enumeration.hpp"
#include "simd/branch_kernel.hpp"
#include "simd/kernels.hpp"
#include "simd/regular_kernel.hpp"

namespace {

namespace lanes = iksel::lanes;
using iksel::all_branches;
using iksel::ClosedFormChain;
using iksel::JointVector;
using iksel::Pose;
using iksel::Robot;
using iksel_test::AxisChain;
using iksel_test::AxisMaker;
using iksel_test::branch_of;
using iksel_test::Closure;
using iksel_test::Dice;
using iksel_test::kTwoPi;

/// Of random matrices whose singular values are spread by up to 1e6, against Eigen's decomposition.
TEST(ClosedFormKernel, TheInverseNormIsThatOfTheSingularValues) {
  std::srand(static_cast<unsigned>(iksel_test::seed()));
  for (int i = 0; i < iksel_test::cases(300); ++i) {
    iksel::Matrix6 A = iksel::Matrix6::Random();
    A.col(i % 6) =
        A.col((i + 1) % 6) + std::pow(10.0, -(i % 7)) * iksel::Vector6(iksel::Vector6::Random());
    double columns[6][6];
    for (int k = 0; k < 6; ++k) {
      Eigen::Map<iksel::Vector6> column(columns[k]);
      column = A.col(k);
    }
    const double expected =
        Eigen::JacobiSVD<iksel::Matrix6>(A).singularValues().cwiseInverse().norm();
    EXPECT_NEAR(lanes::inverse_norm(columns), expected, 1e-8 * expected) << A;
  }
  double singular[6][6] = {};
  EXPECT_FALSE(lanes::inverse_norm(singular) < std::numeric_limits<double>::max());
}

TEST(ClosedFormKernel, AnglesAreThoseOfTheStandardLibrary) {
  iksel::Random random(iksel_test::seed());
  const auto expect_near = [](double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double difference = lanes::to_radians(lanes::Angle<double>{c, s}) - std::atan2(s, c);
    EXPECT_LE(std::abs(std::remainder(difference, kTwoPi)), 1e-15) << angle;
  };
  for (int i = 0; i < 100'000; ++i) expect_near(random.uniform(-M_PI, M_PI));
  for (int k = -8; k <= 8; ++k) {
    for (const double beside : {0.0, 1e-16, 1e-9, 1e-3}) {
      expect_near(k * M_PI / 8 + beside);
      expect_near(k * M_PI / 8 - beside);
    }
  }
  // Exact ones, with zeros of both signs.
  for (const auto& [c, s] :
       {std::pair(1.0, 0.0), {1.0, -0.0}, {0.0, 1.0}, {0.0, -1.0}, {-1.0, 0.0}, {-1.0, -0.0}}) {
    const double difference = lanes::to_radians(lanes::Angle<double>{c, s}) - std::atan2(s, c);
    EXPECT_LE(std::abs(std::remainder(difference, kTwoPi)), 1e-15) << c << " " << s;
  }
}

/// The farthest that a joint of a is from b, whole turns counting nothing.
double turned_away(const JointVector& a, const JointVector& b) {
  double largest = 0;
  for (int j = 0; j < a.size(); ++j) {
    largest = std::max(largest, std::abs(std::remainder(a[j] - b[j], kTwoPi)));
  }
  return largest;
}

/// An angle off by more says nothing.
constexpr double kVague = 0.3;

/// Random chains of a class, one after the other: (class, seen from its end).
class ClosedChains : public testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  [[nodiscard]] Closure closure() const {
    return iksel_test::kClosures[static_cast<std::size_t>(std::get<0>(GetParam()))];
  }
  [[nodiscard]] bool is_reversed() const { return std::get<1>(GetParam()); }

  /// check(robot, form, dice) for each.
  template <typename Check>
  void for_each_chain(int count, const Check& check) const {
    for (int i = 0; i < count; ++i) {
      const std::uint64_t seed = iksel_test::seed() * 1000 + static_cast<std::uint64_t>(i);
      SCOPED_TRACE("chain of seed " + std::to_string(seed));
      Dice dice(seed);
      const AxisChain axes = AxisMaker(dice).make(closure(), is_reversed());
      const Robot robot = iksel_test::make_robot(axes, dice);
      auto chain = iksel::find_closed_form(robot.model());
      ASSERT_TRUE(chain.has_value());
      EXPECT_EQ(chain->form.closure, closure());
      EXPECT_EQ(chain->reversed, is_reversed());
      EXPECT_EQ(iksel::find_structure(robot).kind, iksel::StructureKind::closed_form);
      chain->use_limits(robot.model());
      check(robot, *chain, dice);
    }
  }
};

TEST_P(ClosedChains, BranchesAreSolutionsAndHoldTheOneThatWasPutIn) {
  constexpr double kUnclear = 1e-5;
  int vague = 0;
  int branches = 0;
  for_each_chain(iksel_test::cases(40, 20), [&](const Robot& robot, ClosedFormChain& chain, Dice&) {
    chain.form.error = 1e-12;
    auto pack = all_branches();
    const auto& kernels = lanes::choose_kernels();
    const Eigen::MatrixXd q = robot.random_configurations(10, iksel_test::seed());
    for (int i = 0; i < q.rows(); ++i) {
      const Pose target = robot.fk(q.row(i));
      chain.set_target(iksel_test::reduced(robot, target), pack);
      kernels.solve_branches(chain.form, pack);
      bool is_known = false;
      for (int lane = 0; lane < lanes::kWidth; ++lane) {
        if (pack.best[lane] < 0) continue;
        ++branches;
        EXPECT_LE(pack.beyond[lane], 1e-15);
        const JointVector at = branch_of(chain, pack, lane);
        is_known = is_known || turned_away(at, q.row(i)) <= 1e-9 + pack.error[lane];
        // Rounding has grown as the error has, from a thousandth of it.
        vague += pack.error[lane] > kUnclear;
        if (pack.error[lane] > kUnclear || pack.least[lane] < 0) continue;
        EXPECT_LE(iksel::pose_error(target, robot.fk(at)).norm(), 1e-8)
            << "lane " << lane << " of q = " << q.row(i);
      }
      EXPECT_TRUE(is_known) << q.row(i);
    }
  });
  EXPECT_LE(vague, branches / 5);
}

/// What a no rests on: q within the tolerance of a target is near to a branch of it, however near
/// the arm is to a singularity.
TEST_P(ClosedChains, WhatTheErrorSaysIsTrueBesideSingularities) {
  constexpr double kTolerance = 1e-6;
  int clear = 0;
  int all = 0;
  for_each_chain(iksel_test::cases(40, 20), [&](const Robot& robot, ClosedFormChain& chain,
                                                Dice& dice) {
    // As Enumeration has it.
    chain.form.error = 4 * std::max(kTolerance / chain.unit, kTolerance);
    auto pack = all_branches();
    const auto& kernels = lanes::choose_kernels();
    const Eigen::MatrixXd random = robot.random_configurations(20, iksel_test::seed());
    for (int i = 0; i < random.rows(); ++i) {
      JointVector q = random.row(i);
      const int j = dice.pick(6);
      if (iksel_test::make_singular(robot, j, q)) {
        q[j] += std::pow(10.0, -dice.uniform(0.5, 9));
      }
      const Pose target = iksel_test::shifted(robot.fk(q), kTolerance, kTolerance, dice);
      chain.set_target(iksel_test::reduced(robot, target), pack);
      kernels.solve_branches(chain.form, pack);
      bool is_known = false;
      bool is_vague = false;
      for (int lane = 0; lane < lanes::kWidth; ++lane) {
        if (pack.best[lane] < 0) continue;
        if (!(pack.error[lane] < kVague)) is_vague = true;
        is_known = is_known || turned_away(branch_of(chain, pack, lane), q) <= pack.error[lane];
      }
      ++all;
      clear += !is_vague;
      EXPECT_TRUE(is_known || is_vague) << "q = " << q.transpose() << ", singular by joint " << j;
    }
  });
  EXPECT_GE(clear, all / 20);
}

TEST_P(ClosedChains, EveryLevelGivesTheSameBranches) {
  for_each_chain(
      iksel_test::cases(40) / 8 + 1, [&](const Robot& robot, ClosedFormChain& chain, Dice&) {
        chain.form.error = 1e-12;
        const Eigen::MatrixXd q = robot.random_configurations(10, iksel_test::seed());
        for (int i = 0; i < q.rows(); ++i) {
          auto reference = all_branches();
          chain.set_target(iksel_test::reduced(robot, robot.fk(q.row(i))), reference);
          auto pack = reference;
          auto found = reference;
          auto inside = reference;
          lanes::kKernelsScalar.solve_branches(chain.form, reference);
          for (const std::string& level : iksel_test::levels()) {
            const iksel_test::ForcedLevel forced(level);
            lanes::choose_kernels().solve_branches(chain.form, pack);
            lanes::choose_kernels().find_branches(chain.form, found);
            lanes::choose_kernels().solve_inside(chain.form, inside);
            for (int lane = 0; lane < lanes::kWidth; ++lane) {
              const double least = reference.least[lane];
              EXPECT_NEAR(pack.least[lane], least, 1e-10 * (1 + std::abs(least))) << level;
              EXPECT_NEAR(found.least[lane], least, 1e-10 * (1 + std::abs(least))) << level;
              const bool is_none = iksel::is_ruled_out(pack, lane);
              EXPECT_EQ(iksel::is_ruled_out(inside, lane), is_none) << level;
              if (!is_none) {
                EXPECT_EQ(branch_of(chain, inside, lane), branch_of(chain, pack, lane)) << level;
                EXPECT_EQ(inside.beyond[lane], pack.beyond[lane]) << level;
              }
              if (least < 1e-12 || reference.error[lane] > 1e-8) continue;
              const JointVector expected = branch_of(chain, reference, lane);
              EXPECT_LE(turned_away(branch_of(chain, pack, lane), expected), 1e-9) << level;
              EXPECT_LE(turned_away(branch_of(chain, found, lane), expected), 1e-9) << level;
              EXPECT_NEAR(pack.beyond[lane], found.beyond[lane], 1e-9) << level;
            }
          }
        }
      });
}

/// An axis off by so much: by rounding, nearly as it should be, or not at all.
TEST_P(ClosedChains, IsOneUpToRoundingOnly) {
  const int n = iksel_test::cases(40) / 8 + 1;
  int refused = 0;
  for_each_chain(n, [&](const Robot&, ClosedFormChain&, Dice& dice) {
    AxisMaker maker(dice);
    const AxisChain axes = maker.make(closure(), is_reversed());
    // One that belongs to the class's parallel or meeting axes, whatever the class.
    const std::size_t at = closure() == Closure::three_parallel ? 2 : 4;
    const std::size_t i = is_reversed() ? 5 - at : at;
    const Eigen::Vector3d across = axes.h[i].unitOrthogonal();
    const auto structure = [&](double off) {
      AxisChain other = axes;
      other.h[i] = (axes.h[i] + off * across).normalized();
      // Turned about its point, it must not pass through where the others meet.
      other.p[i] += 0.5 * (at == 4 ? axes.h[i] : Eigen::Vector3d::Zero());
      return iksel::find_structure(iksel_test::make_robot(other, dice));
    };
    const auto is_nearly = [](const iksel::Structure& found) {
      return found.description.find("nearly") != std::string::npos;
    };
    const auto exact = structure(1e-11);
    EXPECT_EQ(exact.kind, iksel::StructureKind::closed_form);
    EXPECT_FALSE(is_nearly(exact)) << exact.description;
    // Where solutions known beforehand are too far from those of the regular arm, it is refused.
    const auto nearly = structure(1e-6);
    EXPECT_EQ(nearly.kind == iksel::StructureKind::closed_form, is_nearly(nearly))
        << nearly.description;
    refused += is_nearly(nearly) ? 0 : 1;
    EXPECT_NE(structure(1e-2).kind, iksel::StructureKind::closed_form);
  });
  EXPECT_LE(refused, n / 20) << "of " << n << ", seed " << iksel_test::seed();
}

INSTANTIATE_TEST_SUITE_P(Each, ClosedChains,
                         testing::Combine(testing::Range(0, 5), testing::Bool()));

}  // namespace
