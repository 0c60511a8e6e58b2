// SPDX-License-Identifier: BSD-3-Clause
// Roots of residuals that are known: products of sines of half the angles from them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "odd_maker.hpp"
#include "robots.hpp"
#include "seeds/root_finder.hpp"
#include "simd/kernels.hpp"

namespace {

using iksel::RootFinder;
using iksel_test::Dice;

constexpr double kPi = 3.14159265358979323846;
constexpr double kCell = 2 * kPi / RootFinder::kCells;

/// Real roots, and pairs of roots that are `imaginary` away from the real line.
struct Known {
  std::vector<double> real;
  std::vector<std::complex<double>> pairs;

  [[nodiscard]] double at(double angle) const {
    double product = 1;
    for (const double root : real) product *= std::sin(0.5 * (angle - root));
    for (const auto& root : pairs) product *= std::norm(std::sin(0.5 * (angle - root)));
    return product;
  }
};

/// How far angles are from each other, modulo whole turns.
double between(double a, double b) { return std::abs(std::remainder(a - b, 2 * kPi)); }

RootFinder find_roots(const Known& known) {
  RootFinder finder(-kPi, 2 * kPi, /*vague=*/2e-3, /*faint=*/0, /*precision=*/5e-10,
                    iksel::lanes::kKernelsScalar);
  finder.find([&](const double* angles, int n, double* values) {
    for (int i = 0; i < n; ++i) values[i] = known.at(angles[i]);
  });
  return finder;
}

TEST(RootFinder, FindsRealRoots) {
  Dice dice(iksel_test::seed());
  for (int i = 0; i < iksel_test::cases(300); ++i) {
    Known known;
    for (int k = 0; k < 8; ++k) known.real.push_back(2 * kPi * k / 8 + dice.uniform(-0.3, 0.3));
    const RootFinder finder = find_roots(known);
    ASSERT_EQ(finder.size(), known.real.size()) << i << ", seed " << iksel_test::seed();
    for (const double root : known.real) {
      double least = 10;
      for (std::size_t k = 0; k < finder.size(); ++k) {
        least = std::min(least, between(finder[k].angle, root));
      }
      EXPECT_LT(least, 1e-8) << i << ", seed " << iksel_test::seed();
    }
  }
}

TEST(RootFinder, NothingIsDoubtfulWhereRootsAreFarApart) {
  const Known known{{-2, -1, 0.5, 2.5}, {{-3, 0.4}, {1.5, 0.5}}};
  std::array<double, RootFinder::kMostDoubtful> angles;
  EXPECT_EQ(find_roots(known).find_doubtful(angles), 0U);
}

/// Also where a real root is beside the pair, so that the residual does not turn there.
TEST(RootFinder, WhereAPairIsNearlyRealIsDoubtful) {
  Dice dice(iksel_test::seed());
  for (int i = 0; i < iksel_test::cases(2000); ++i) {
    const double angle = dice.uniform(-kPi, kPi);
    Known known;
    known.pairs.emplace_back(angle, dice.uniform(0.0, 0.9 * kCell));
    known.real.push_back(angle + dice.uniform(-1, 1));
    if (dice.chance(0.5)) known.real.push_back(angle + dice.uniform(-0.06, 0.06));
    while (known.real.size() < 4) known.real.push_back(angle + dice.uniform(1, 5));
    std::array<double, RootFinder::kMostDoubtful> angles;
    const std::size_t n = find_roots(known).find_doubtful(angles);
    double least = 10;
    for (std::size_t k = 0; k < n; ++k) least = std::min(least, between(angles[k], angle));
    // Beside a root that is real they are a quarter of a cell away from that.
    EXPECT_LT(least, 0.51 * kCell) << i << ", seed " << iksel_test::seed() << ", " << n
                                   << " doubtful, off the real line by " << known.pairs[0].imag();
  }
}

}  // namespace
