// SPDX-License-Identifier: BSD-3-Clause
// Query, rank and re-selection against a plain rewriting of the paper's text.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "database/data.hpp"
#include "iksel/iksel.hpp"
#include "kinematics/chain_model.hpp"
#include "robots.hpp"
#include "seeds/selection.hpp"

namespace {

using iksel::Database;
using iksel::JointVector;
using iksel::Ranking;
using iksel::Reselection;
using iksel::Robot;
using iksel_test::pose_vector;

struct Bench {
  Robot robot = iksel_test::robot("irb14050");
  iksel::Paper paper;
  Database database = [this] {
    iksel::DatabaseOptions o;
    o.samples = 4000;
    o.key_scheme = iksel::KeyScheme::full;
    o.rotation_weight = 1;
    return Database::build(robot, o);
  }();
  Robot bare = robot.with_tcp(iksel::Pose::Identity());
};

/// Indices of the samples in the paper's order, all neighbours.
std::vector<std::size_t> reference_order(const Bench& s, const iksel::Pose& target) {
  const Eigen::Matrix<double, 6, 1> x_t = pose_vector(target);
  std::vector<double> distance(s.database.size());
  std::vector<double> adjustment(s.database.size());
  for (std::size_t i = 0; i < s.database.size(); ++i) {
    const Eigen::Matrix<double, 6, 1> e = x_t - pose_vector(s.database.pose(i));
    distance[i] = e.norm();
    adjustment[i] = (s.database.pseudo_inverse(i) * e).norm();
  }
  std::vector<std::size_t> order(s.database.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
  order.resize(static_cast<std::size_t>(s.paper.neighbours));
  if (s.paper.ranking == Ranking::joint_adjustment) {
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return adjustment[a] < adjustment[b]; });
  }
  order.resize(static_cast<std::size_t>(s.paper.candidates));
  return order;
}

std::vector<JointVector> seeds(const Bench& s, const iksel::Pose& target, int attempts) {
  iksel::Selection selection(&s.robot.model(), &s.robot.model(), s.database.data(), s.paper);
  selection.query(target);
  selection.rank();
  std::vector<JointVector> out;
  for (int i = 0; i < attempts; ++i) {
    const double* q = selection.next_seed();
    if (q == nullptr) break;
    out.emplace_back(Eigen::Map<const Eigen::VectorXd>(q, s.robot.dof()));
  }
  return out;
}

class Rankings : public testing::TestWithParam<Ranking> {};

TEST_P(Rankings, FollowThePaper) {
  Bench s;
  s.paper.ranking = GetParam();
  s.paper.reselection = Reselection::next;
  const Eigen::MatrixXd q = s.robot.random_configurations(30, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const iksel::Pose target = s.bare.fk(q.row(i));
    const auto expected = reference_order(s, target);
    const auto found = seeds(s, target, 100);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k], s.database.q(expected[k])) << "target " << i << " rank " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Rankings,
                         testing::Values(Ranking::nearest, Ranking::joint_adjustment));

TEST(Reselection, TakesTheFarthestFromTheFailed) {
  const Bench s;
  const Eigen::MatrixXd q = s.robot.random_configurations(30, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const iksel::Pose target = s.bare.fk(q.row(i));
    const auto order = reference_order(s, target);
    std::vector<JointVector> left;
    for (const std::size_t index : order) left.push_back(s.database.q(index));
    const auto found = seeds(s, target, 20);
    ASSERT_EQ(found.size(), left.size());
    JointVector sum = JointVector::Zero(s.robot.dof());
    for (std::size_t m = 0; m < found.size(); ++m) {
      auto best = left.begin();
      if (m > 0) {
        best = std::max_element(left.begin(), left.end(),
                                [&](const JointVector& a, const JointVector& b) {
                                  const auto n = static_cast<double>(m);
                                  return (n * a - sum).norm() < (n * b - sum).norm();
                                });
      }
      EXPECT_EQ(found[m], *best) << "target " << i << " after " << m << " failures";
      sum += *best;
      left.erase(best);
    }
  }
}

TEST(Reselection, NoneTriesOneSeed) {
  Bench s;
  s.paper.reselection = Reselection::none;
  const iksel::Pose target = s.bare.fk(s.robot.random_configurations(1, 1).row(0));
  EXPECT_EQ(seeds(s, target, 20).size(), 1U);
}

TEST(NeighbourRadius, LeavesOutWhatIsFarther) {
  Bench s;
  s.paper.reselection = Reselection::next;
  s.paper.candidates = s.paper.neighbours;
  const Eigen::MatrixXd q = s.robot.random_configurations(30, iksel_test::seed());
  int some = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const iksel::Pose target = s.bare.fk(q.row(i));
    s.paper.neighbour_radius = 0.5;
    std::vector<JointVector> expected;
    for (const std::size_t index : reference_order(s, target)) {
      const double distance = (pose_vector(target) - pose_vector(s.database.pose(index))).norm();
      if (distance <= s.paper.neighbour_radius) expected.push_back(s.database.q(index));
    }
    EXPECT_EQ(seeds(s, target, s.paper.neighbours), expected) << "target " << i;
    some += !expected.empty() && expected.size() < 200;
    s.paper.neighbour_radius = 1e-6;
    EXPECT_TRUE(seeds(s, target, 1).empty());
  }
  EXPECT_GT(some, 5) << "seed " << iksel_test::seed();
}

TEST(LimitAware, PutsSeedsThatWouldLeaveTheLimitsLast) {
  Bench s;
  s.paper.limit_aware = true;
  s.paper.reselection = Reselection::next;
  s.paper.candidates = s.paper.neighbours;
  const Eigen::MatrixXd q = s.robot.random_configurations(30, iksel_test::seed());
  int mixed = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const iksel::Pose target = s.bare.fk(q.row(i));
    bool seen_leaving = false;
    bool seen_staying = false;
    double last = -1;
    for (const JointVector& seed : seeds(s, target, s.paper.neighbours)) {
      // The sample is found again by its joints.
      const auto near = s.database.nearest(target, 200);
      const auto index = *std::find_if(near.begin(), near.end(),
                                       [&](std::size_t k) { return s.database.q(k) == seed; });
      const Eigen::Matrix<double, 6, 1> e =
          pose_vector(target) - pose_vector(s.database.pose(index));
      const Eigen::VectorXd adjustment = s.database.pseudo_inverse(index) * e;
      bool leaves = false;
      for (int j = 0; j < s.robot.dof(); ++j) {
        const double predicted = seed[j] + adjustment[j];
        const bool free = s.robot.upper()[j] - s.robot.lower()[j] >= 6.283185307179586;
        leaves |= !free && (predicted < s.robot.lower()[j] || predicted > s.robot.upper()[j]);
      }
      if (leaves && !seen_leaving) last = -1;
      EXPECT_FALSE(seen_leaving && !leaves);
      EXPECT_GE(adjustment.norm(), last - 1e-12);
      last = adjustment.norm();
      seen_leaving |= leaves;
      seen_staying |= !leaves;
    }
    mixed += seen_leaving && seen_staying;
  }
  EXPECT_GT(mixed, 5);
}

class RotationKeys : public testing::TestWithParam<iksel::RotationKey> {};

TEST_P(RotationKeys, SolveAlike) {
  const Robot& robot = iksel_test::robot("irb14050");
  iksel::SolverOptions options = iksel::SolverOptions::paper();
  options.database.scale = iksel::Scale::small;
  options.database.rotation_key = GetParam();
  const iksel::Solver solver(robot, options);
  // Footnote 1 of the paper: no significant difference.
  const int n = iksel_test::cases(1000);
  EXPECT_GE(iksel_test::count_solved(solver, n), n * 88 / 100 - 5) << "seed " << iksel_test::seed();
}

INSTANTIATE_TEST_SUITE_P(All, RotationKeys,
                         testing::Values(iksel::RotationKey::rotation_vector,
                                         iksel::RotationKey::quaternion, iksel::RotationKey::matrix,
                                         iksel::RotationKey::euler,
                                         iksel::RotationKey::dual_quaternion));

}  // namespace
