// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <iksel/iksel.hpp>
#include <set>
#include <vector>

#include "base/random.hpp"
#include "robots.hpp"

namespace {

using iksel::Database;
using iksel::DatabaseOptions;
using iksel::Robot;
using iksel::Sampling;
using iksel::Scale;

TEST(Grid, HasThePapersCounts) {
  using Counts = std::vector<int>;
  EXPECT_EQ(iksel::grid_counts(6, Scale::small), (Counts{6, 5, 5, 5, 4, 4}));
  EXPECT_EQ(iksel::grid_counts(6, Scale::medium), (Counts{8, 7, 6, 6, 5, 4}));
  EXPECT_EQ(iksel::grid_counts(6, Scale::large), (Counts{10, 9, 8, 7, 6, 5}));
  EXPECT_EQ(iksel::grid_counts(7, Scale::small), (Counts{6, 5, 5, 5, 4, 4, 4}));
  EXPECT_EQ(iksel::grid_counts(7, Scale::medium), (Counts{8, 7, 6, 6, 5, 5, 4}));
  EXPECT_EQ(iksel::grid_counts(7, Scale::large), (Counts{10, 9, 8, 7, 6, 5, 4}));
}

TEST(Grid, StaysAffordableForLongChains) {
  for (int dof = 8; dof <= iksel::kMaxDof; ++dof) {
    for (const Scale scale : {Scale::small, Scale::medium, Scale::large}) {
      double product = 1;
      for (const int count : iksel::grid_counts(dof, scale)) product *= count;
      EXPECT_LE(product, 604'800);
      EXPECT_GE(product, 1000);
    }
  }
}

TEST(Grid, TakesInteriorPointsOfEveryJoint) {
  const Robot& robot = iksel_test::robot("cvr038");
  DatabaseOptions options = DatabaseOptions::paper();
  options.scale = Scale::small;
  const Database database = Database::build(robot, options);
  ASSERT_EQ(database.size(), 12'000U);
  const std::vector<int> counts = iksel::grid_counts(6, Scale::small);
  for (int j = 0; j < 6; ++j) {
    std::set<double> values;
    for (std::size_t i = 0; i < database.size(); ++i) values.insert(database.q(i)[j]);
    ASSERT_EQ(values.size(), static_cast<std::size_t>(counts[static_cast<std::size_t>(j)]));
    const double range = robot.upper()[j] - robot.lower()[j];
    EXPECT_NEAR(*values.begin(),
                robot.lower()[j] + range / (counts[static_cast<std::size_t>(j)] + 1), 1e-12);
  }
}

class Samplings : public testing::TestWithParam<Sampling> {};

DatabaseOptions small(Sampling sampling) {
  DatabaseOptions options;
  options.sampling = sampling;
  options.samples = 3000;
  options.scale = Scale::small;
  if (sampling == Sampling::cvt) options.cvt_updates = 20'000;
  if (sampling == Sampling::kmeans) options.kmeans_pool = 10'000;
  options.seed = 7;
  options.key_scheme = iksel::KeyScheme::full;
  return options;
}

TEST_P(Samplings, LieInsideTheLimitsAndCarryTheirKinematics) {
  for (const char* name : {"gen3_6dof", "irb14050"}) {
    const Robot& robot = iksel_test::robot(name);
    const Robot bare = robot.with_tcp(iksel::Pose::Identity());
    DatabaseOptions options = small(GetParam());
    const Database database = Database::build(robot, options);
    for (std::size_t i = 0; i < database.size(); i += 37) {
      const iksel::JointVector q = database.q(i);
      EXPECT_TRUE(robot.within_limits(q));
      EXPECT_LT((database.pose(i).matrix() - bare.fk(q).matrix()).norm(), 1e-9);
      const Eigen::MatrixXd J = bare.jacobian(q);
      const Eigen::MatrixXd P = database.pseudo_inverse(i);
      // Moore and Penrose, where nothing was cut off.
      EXPECT_LT((P * J * P - P).norm(), 1e-8 * P.norm());
      EXPECT_LT((J * P - (J * P).transpose()).norm(), 1e-8);
    }
  }
}

TEST_P(Samplings, HaveTheSameBitsForAnyNumberOfThreads) {
  const Robot& robot = iksel_test::robot("cvrb1213");
  DatabaseOptions options = small(GetParam());
  options.threads = 1;
  const std::string one = Database::build(robot, options).to_bytes();
  for (const int threads : {2, 8}) {
    options.threads = threads;
    EXPECT_EQ(one, Database::build(robot, options).to_bytes()) << threads << " threads";
  }
  if (GetParam() != Sampling::grid) {
    options.seed = 8;
    EXPECT_NE(one, Database::build(robot, options).to_bytes());
  }
}

INSTANTIATE_TEST_SUITE_P(All, Samplings,
                         testing::Values(Sampling::grid, Sampling::cvt, Sampling::low_discrepancy,
                                         Sampling::random, Sampling::kmeans));

/// Mean distance from random configurations to the nearest sample, joints scaled to [0, 1].
double covering(const Robot& robot, const Database& database) {
  const Eigen::MatrixXd probes = robot.random_configurations(300, 99);
  const Eigen::VectorXd range = robot.upper() - robot.lower();
  double sum = 0;
  for (Eigen::Index i = 0; i < probes.rows(); ++i) {
    double best = 1e9;
    for (std::size_t k = 0; k < database.size(); ++k) {
      const Eigen::VectorXd d = probes.row(i).transpose() - database.q(k);
      best = std::min(best, d.cwiseQuotient(range).norm());
    }
    sum += best;
  }
  return sum / static_cast<double>(probes.rows());
}

TEST(Cvt, CoversBetterThanRandomSamples) {
  const Robot& robot = iksel_test::robot("cvr038");
  DatabaseOptions options = small(Sampling::cvt);
  options.cvt_updates = 100'000;
  const double cvt = covering(robot, Database::build(robot, options));
  const Database random = Database::build(robot, small(Sampling::random));
  EXPECT_LT(cvt, 0.97 * covering(robot, random));
}

/// Joint values of all samples, in lexicographic order.
std::vector<std::vector<double>> sorted_samples(const Database& database) {
  std::vector<std::vector<double>> all;
  for (std::size_t i = 0; i < database.size(); ++i) {
    const iksel::JointVector q = database.q(i);
    all.emplace_back(q.begin(), q.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// One of Lloyd's rounds by brute force.
std::vector<std::vector<double>> move_to_means(const std::vector<std::vector<double>>& samples,
                                               const Eigen::MatrixXd& pool) {
  std::vector<Eigen::VectorXd> sums(samples.size(), Eigen::VectorXd::Zero(pool.cols()));
  std::vector<int> hits(samples.size(), 0);
  for (Eigen::Index i = 0; i < pool.rows(); ++i) {
    double best = 1e9;
    std::size_t nearest = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Eigen::Map<const Eigen::VectorXd> q(samples[k].data(), pool.cols());
      const double distance = (pool.row(i).transpose() - q).squaredNorm();
      if (distance < best) nearest = k;
      best = std::min(best, distance);
    }
    sums[nearest] += pool.row(i).transpose();
    ++hits[nearest];
  }
  std::vector<std::vector<double>> moved = samples;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (hits[k] == 0) continue;
    const Eigen::VectorXd mean = sums[k] / hits[k];
    moved[k].assign(mean.begin(), mean.end());
  }
  return moved;
}

TEST(Kmeans, IsLloydsByBruteForce) {
  const Robot& robot = iksel_test::robot("irb14050");
  DatabaseOptions options = small(Sampling::random);
  // Few points for so many samples: some are nearest to none, and stay.
  options.samples = 200;
  std::vector<std::vector<double>> expected = sorted_samples(Database::build(robot, options));
  options.sampling = Sampling::kmeans;
  options.kmeans_pool = 400;
  Eigen::MatrixXd pool(400, robot.dof());
  for (Eigen::Index i = 0; i < pool.rows(); ++i) {
    auto random = iksel::Random::stream(options.seed + 1, static_cast<std::uint64_t>(i));
    for (int j = 0; j < robot.dof(); ++j) {
      pool(i, j) = random.uniform(robot.lower()[j], robot.upper()[j]);
    }
  }
  for (int round = 0; round < 4; ++round) {
    options.kmeans_rounds = round;
    const auto samples = sorted_samples(Database::build(robot, options));
    std::vector<std::vector<double>> sorted = expected;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t k = 0; k < samples.size(); ++k) {
      for (std::size_t j = 0; j < samples[k].size(); ++j) {
        EXPECT_NEAR(samples[k][j], sorted[k][j], 1e-12) << "round " << round;
      }
    }
    expected = move_to_means(expected, pool);
  }
}

TEST(Kmeans, LeavesLessBetweenItsSamplesThanCvt) {
  const Robot& robot = iksel_test::robot("cvr038");
  DatabaseOptions options = small(Sampling::kmeans);
  options.kmeans_pool = 100'000;
  const double kmeans = covering(robot, Database::build(robot, options));
  DatabaseOptions others = small(Sampling::cvt);
  others.cvt_updates = options.kmeans_pool;
  EXPECT_LT(kmeans, covering(robot, Database::build(robot, others)));
}

TEST(Build, ReportsProgressUpToTheEnd) {
  const Robot& robot = iksel_test::robot("cvr038");
  std::size_t last = 0;
  std::size_t all = 0;
  int calls = 0;
  Database::build(robot, small(Sampling::random), [&](std::size_t done, std::size_t total) {
    if (calls++ == 0) {
      EXPECT_EQ(done, 0U);
    } else {
      EXPECT_GT(done, last);
    }
    EXPECT_LE(done, total);
    last = done;
    all = total;
  });
  EXPECT_GT(calls, 3);
  EXPECT_EQ(last, all);
  EXPECT_EQ(all, 3000U);
}

TEST(Build, ReportsEachLookAtAPointOfThePool) {
  std::size_t last = 0;
  DatabaseOptions options = small(Sampling::kmeans);
  options.kmeans_rounds = 3;
  Database::build(iksel_test::robot("cvr038"), options, [&](std::size_t done, std::size_t total) {
    EXPECT_TRUE(done > last || done == 0);
    EXPECT_EQ(total, 3 * 10'000U + 3000U);
    last = done;
  });
  EXPECT_EQ(last, 33'000U);
}

TEST(Build, EndsWithTheExceptionOfItsProgress) {
  const Robot& robot = iksel_test::robot("cvr038");
  const auto cancel = [](std::size_t, std::size_t) { throw std::runtime_error("enough"); };
  EXPECT_THROW(Database::build(robot, small(Sampling::random), cancel), std::runtime_error);
}

TEST(Build, RefusesOptionsOutOfRange) {
  const Robot& robot = iksel_test::robot("cvr038");
  DatabaseOptions options;
  options.pinv_cutoff = -1;
  EXPECT_THROW(Database::build(robot, options), iksel::InvalidArgumentError);
  options = {};
  options.threads = -2;
  EXPECT_THROW(Database::build(robot, options), iksel::InvalidArgumentError);
  options = {};
  options.rotation_weight = std::nan("");
  EXPECT_THROW(Database::build(robot, options), iksel::InvalidArgumentError);
  options = {};
  options.kmeans_pool = 5;  // nobody reads it
  EXPECT_THROW(Database::build(robot, options), iksel::InvalidArgumentError);
  options.sampling = Sampling::kmeans;
  EXPECT_NO_THROW(Database::build(robot, options));
  options.kmeans_pool = 0;
  EXPECT_THROW(Database::build(robot, options), iksel::InvalidArgumentError);
  options = {};
  options.cvt_updates = 5;  // nor this
  EXPECT_THROW(Database::build(robot, options), iksel::InvalidArgumentError);
  EXPECT_THROW((void)DatabaseOptions::paper(2024), iksel::InvalidArgumentError);
}

}  // namespace
