// SPDX-License-Identifier: BSD-3-Clause
// Many random reachable poses: how many are solved, and that nothing which says success is none, by
// KDL's FK and the limits. In release builds only.
#include <gtest/gtest.h>

#include <cmath>
#include <iksel/iksel.hpp>
#include <map>
#include <string>

#include "levels.hpp"
#include "robots.hpp"

namespace {

using iksel_test::count_solved;

class Statistics : public testing::TestWithParam<std::string> {};

TEST_P(Statistics, TheDefaultSolvesAll) {
  const int n = iksel_test::cases(100'000);
  EXPECT_EQ(count_solved(iksel_test::solver(GetParam()), n), n) << "seed " << iksel_test::seed();
}

TEST_P(Statistics, ThePaperReachesItsPublishedSuccess) {
  // Table I, medium [%].
  const std::map<std::string, double> published = {
      {"cvr038", 87.59}, {"cvrb1213", 86.75}, {"ur3_wrs", 73.17}, {"irb14050", 95.67}};
  const int n = iksel_test::cases(20'000);
  const double percent = 100.0 * count_solved(iksel_test::paper_solver(GetParam()), n) / n;
  // What differs for other reasons, and four standard deviations of the worst case.
  const double room = 3 + 4 * 50 / std::sqrt(n);
  EXPECT_NEAR(percent, published.at(GetParam()), room) << "seed " << iksel_test::seed();
}

INSTANTIATE_TEST_SUITE_P(Robots, Statistics, testing::ValuesIn(iksel_test::paper_robots()),
                         iksel_test::name_of);

class StatisticsOfLevels : public testing::TestWithParam<std::string> {};

TEST_P(StatisticsOfLevels, EachSolvesAll) {
  const iksel::Robot& robot = iksel_test::robot(GetParam());
  const int n = iksel_test::cases(2000);
  for (const std::string& level : iksel_test::levels()) {
    const iksel_test::ForcedLevel forced(level);
    ASSERT_EQ(iksel::simd_level(), level);
    const iksel::Solver solver(robot, {}, iksel_test::solver(GetParam()).database());
    EXPECT_EQ(count_solved(solver, n), n) << level << ", seed " << iksel_test::seed();
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, StatisticsOfLevels, testing::ValuesIn(iksel_test::all_robots()),
                         iksel_test::name_of);

}  // namespace
