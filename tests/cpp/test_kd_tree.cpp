// SPDX-License-Identifier: BSD-3-Clause
// The tree against brute force. Distances are compared, not indices: ties may fall either way.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/random.hpp"
#include "database/kd_tree.hpp"
#include "robots.hpp"

namespace {

enum class Cloud { uniform, clustered, grid, line, identical };

class KdTreeTest : public testing::TestWithParam<std::tuple<int, Cloud>> {};

std::vector<double> make_cloud(Cloud cloud, int dimension, std::size_t count,
                               iksel::Random& random) {
  std::vector<double> points(count * static_cast<std::size_t>(dimension));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t row = i / static_cast<std::size_t>(dimension);
    switch (cloud) {
      case Cloud::uniform:
        points[i] = random.uniform(-1, 1);
        break;
      case Cloud::clustered:
        points[i] = static_cast<double>(row % 7) + 1e-3 * random.uniform(-1, 1);
        break;
      case Cloud::grid:
        points[i] = static_cast<double>(random.next() % 4);
        break;
      case Cloud::line:
        points[i] = i % static_cast<std::size_t>(dimension) == 0 ? random.uniform(-1, 1) : 0.5;
        break;
      case Cloud::identical:
        points[i] = 0.25;
        break;
    }
  }
  return points;
}

TEST_P(KdTreeTest, FindsTheDistancesOfBruteForce) {
  const auto [dimension, cloud] = GetParam();
  iksel::Random random(iksel_test::seed());
  constexpr std::size_t kCount = 3000;
  const auto points = make_cloud(cloud, dimension, kCount, random);
  const auto tree = iksel::make_kd_tree(points.data(), kCount, dimension);

  for (int trial = 0; trial < 40; ++trial) {
    std::vector<double> query(static_cast<std::size_t>(dimension));
    for (double& x : query) x = random.uniform(-1.5, 1.5);
    std::vector<double> all;
    for (std::size_t i = 0; i < kCount; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < query.size(); ++j) {
        const double d = points[i * query.size() + j] - query[j];
        sum += d * d;
      }
      all.push_back(sum);
    }
    std::sort(all.begin(), all.end());
    for (const std::size_t k : {1U, 8U, 200U, 3000U, 5000U}) {
      std::vector<iksel::Neighbour> found(k);
      const std::size_t n = tree->nearest(query.data(), k, found.data());
      ASSERT_EQ(n, std::min<std::size_t>(k, kCount));
      std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(n));
      for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(found[i].distance, all[i], 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, KdTreeTest,
                         testing::Combine(testing::Values(3, 6, 7, 12),
                                          testing::Values(Cloud::uniform, Cloud::clustered,
                                                          Cloud::grid, Cloud::line,
                                                          Cloud::identical)));

}  // namespace
