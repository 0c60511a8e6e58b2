// SPDX-License-Identifier: BSD-3-Clause
// What is kept of many solutions: those that lie apart, the cheapest of those that do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "iksel/iksel.hpp"
#include "robots.hpp"
#include "search/solution_set.hpp"
#include "seeds/farthest_first.hpp"
#include "simd/kernels.hpp"

namespace {

using iksel::ChainModel;
using iksel::JointVector;
using iksel::Result;
using iksel::SolutionSet;

const ChainModel& model() { return iksel_test::robot("ur3").model(); }

Result at(const JointVector& q) {
  Result result;
  result.status = iksel::Status::solved;
  result.q = q;
  return result;
}

TEST(SolutionSets, AllLieApartAndTheCheapestStays) {
  constexpr double kApart = 0.2;
  std::mt19937_64 random(iksel_test::seed());
  std::uniform_real_distribution<double> small(-0.3, 0.3);
  std::uniform_real_distribution<double> any_cost(0, 1);
  for (int round = 0; round < 50; ++round) {
    SolutionSet set(model());
    double least = 2;
    for (int i = 0; i < 60; ++i) {
      JointVector q = JointVector::Zero(6);
      // In two joints only, so that many lie near several others.
      q[1] = small(random);
      q[4] = small(random);
      const double cost = any_cost(random);
      least = std::min(least, cost);
      set.add(at(q), cost, kApart);
      for (std::size_t a = 0; a < set.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          ASSERT_GE(model().joints.distance(set.q(a), set.q(b)), kApart)
              << "seed " << iksel_test::seed() << ", round " << round << ", solution " << i;
        }
      }
      ASSERT_EQ(set.least_cost(), least);
    }
    EXPECT_GT(set.replacements(), 0);
  }
}

TEST(SolutionSets, ReplacementsAreTold) {
  SolutionSet set(model());
  JointVector q = JointVector::Zero(6);
  EXPECT_TRUE(set.add(at(q), 1, 0.1));
  q[0] = 0.05;
  EXPECT_FALSE(set.add(at(q), 2, 0.1));
  EXPECT_EQ(set.replacements(), 0);
  EXPECT_FALSE(set.add(at(q), 0.5, 0.1));
  EXPECT_EQ(set.replacements(), 1);
  EXPECT_EQ(set.at(0)[0], 0.05);
  // A whole turn away is near.
  q[0] += 2 * M_PI;
  EXPECT_FALSE(set.add(at(q), 0.5, 0.1));
  EXPECT_EQ(set.size(), 1U);
}

TEST(FarthestFirst, IsThatOfThePlainRule) {
  const auto& joints = model().joints;
  for (const int all : {1, 15, 16, 17, 100}) {
    const auto n = static_cast<std::size_t>(all);
    const Eigen::MatrixXd rows =
        iksel_test::robot("ur3").random_configurations(all, iksel_test::seed());
    std::vector<double> q;
    for (int i = 0; i < all; ++i) {
      for (int j = 0; j < 6; ++j) q.push_back(rows(i, j));
    }
    const auto distance = [&](std::size_t a, std::size_t b) {
      return joints.distance(&q[6 * a], &q[6 * b]);
    };
    const std::vector<std::size_t> chosen =
        iksel::farthest_first(iksel::lanes::choose_kernels(), joints, q.data(), n, 20);
    ASSERT_EQ(chosen.size(), std::min<std::size_t>(20, n));
    EXPECT_EQ(chosen.front(), 0U);
    EXPECT_EQ(std::set<std::size_t>(chosen.begin(), chosen.end()).size(), chosen.size());
    for (std::size_t k = 1; k < chosen.size(); ++k) {
      const auto nearest = [&](std::size_t i) {
        double least = 100;
        for (std::size_t c = 0; c < k; ++c) least = std::min(least, distance(i, chosen[c]));
        return least;
      };
      double farthest = 0;
      for (std::size_t i = 0; i < n; ++i) farthest = std::max(farthest, nearest(i));
      EXPECT_NEAR(nearest(chosen[k]), farthest, 1e-5) << "seed " << iksel_test::seed();
    }
  }
}

}  // namespace
