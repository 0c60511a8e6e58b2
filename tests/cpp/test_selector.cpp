// SPDX-License-Identifier: BSD-3-Clause
// The paper's loop made by hand of the Selector, against the preset that makes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <iksel/iksel.hpp>
#include <string>
#include <utility>
#include <vector>

#include "robots.hpp"

namespace {

using iksel::Candidates;
using iksel::JointVector;
using iksel::Paper;
using iksel::Pose;
using iksel::Ranking;
using iksel::Result;
using iksel::Selector;
using iksel::Solver;
using iksel::SolverOptions;
using iksel_test::paper_of;
using iksel_test::pose_vector;
using Indices = std::vector<std::size_t>;

/// The preset over a small database, with some of its fields changed.
template <typename Change>
Solver paper_solver(const std::string& name, const Change& change) {
  static std::vector<std::pair<std::string, iksel::Database>> made;
  SolverOptions options = SolverOptions::paper();
  options.database.scale = iksel::Scale::small;
  change(options);
  for (const auto& [of, database] : made) {
    if (of == name) return {iksel_test::robot(name), options, database};
  }
  const Solver solver(iksel_test::robot(name), options);
  made.emplace_back(name, solver.database());
  return solver;
}

Pose of_tip_link(const iksel::Robot& robot, const Pose& pose) {
  return pose * robot.tcp().inverse();
}

/// One attempt after the other, by hand.
Result solve_by_hand(const Solver& solver, Selector& selector, const Pose& target) {
  selector.candidates(of_tip_link(solver.robot(), target));
  iksel::SolveRequest request;
  request.database_seeds = false;
  Indices tried;
  Result result;
  int iterations = 0;
  while (!result.success() && static_cast<int>(tried.size()) < solver.options().max_attempts) {
    const auto sample = selector.next(tried);
    if (!sample) break;
    tried.push_back(*sample);
    request.seeds = {solver.database().q(*sample)};
    result = solver.solve(target, request);
    iterations += result.iterations;
  }
  result.iterations = iterations;
  result.attempts = static_cast<int>(tried.size());
  return result;
}

template <typename Change>
void expect_same(const std::string& name, int n, const Change& change) {
  const Solver solver = paper_solver(name, change);
  Selector selector(solver.database(), std::get<Paper>(solver.options().strategy));
  int reselected = 0;
  for (const Pose& target : iksel_test::random_targets(solver.robot(), n)) {
    const Result whole = solver.solve(target);
    const Result by_hand = solve_by_hand(solver, selector, target);
    ASSERT_EQ(whole.success(), by_hand.success()) << name << ", seed " << iksel_test::seed();
    EXPECT_EQ(whole.q, by_hand.q) << name << ", seed " << iksel_test::seed();
    EXPECT_EQ(whole.attempts, by_hand.attempts);
    EXPECT_EQ(whole.iterations, by_hand.iterations);
    reselected += whole.attempts > 1;
  }
  if (solver.options().max_attempts > 1) EXPECT_GT(reselected, 0) << name;
}

TEST(Selector, MakesTheLoopOfThePaperPreset) {
  for (const std::string& name : iksel_test::paper_robots()) {
    expect_same(name, iksel_test::cases(300), [](SolverOptions&) {});
  }
}

TEST(Selector, MakesTheLoopOfEveryScheme) {
  const int n = iksel_test::cases(50, 20);
  const auto with = [&](const auto& change) {
    expect_same("ur3_wrs", n, [&](SolverOptions& options) { change(options, paper_of(options)); });
  };
  with([](SolverOptions& options, Paper&) { options.max_attempts = 100; });
  with([](SolverOptions& options, Paper& paper) {
    options.max_attempts = 100;
    paper.candidates = 60;
  });
  with([](SolverOptions& options, Paper& paper) {
    options.max_attempts = 21;
    paper.ranking = Ranking::nearest;
    paper.neighbours = 30;
  });
  with([](SolverOptions& options, Paper& paper) {
    options.max_attempts = 21;
    paper.reselection = iksel::Reselection::next;
    paper.rotation_difference = iksel::RotationDifference::geodesic;
  });
  with([](SolverOptions& options, Paper& paper) {
    options.max_attempts = 1;
    paper = {};
    paper.reselection = iksel::Reselection::none;
  });
  with([](SolverOptions& options, Paper& paper) {
    options.max_attempts = 5;
    paper.neighbour_radius = 0.6;
    paper.iteration = iksel::Iteration::cwln;
    paper.kinematics = iksel::Kinematics::kernel;
  });
}

TEST(Selector, ItsNumbersAreThoseOfTheEquations) {
  const Solver solver = paper_solver("ur3_wrs", [](SolverOptions&) {});
  const iksel::Database& database = solver.database();
  Selector selector(database);
  for (const Pose& target : iksel_test::random_targets(solver.robot(), 20)) {
    const Pose tip = of_tip_link(solver.robot(), target);
    const Candidates nearest = selector.candidates(tip, 300, Ranking::nearest);
    EXPECT_EQ(nearest.indices, database.nearest(tip, 300));
    EXPECT_TRUE(std::is_sorted(nearest.distances.begin(), nearest.distances.end()));
    const Candidates best = selector.rank(Ranking::joint_adjustment);
    EXPECT_EQ(selector.candidates(tip, 300, Ranking::joint_adjustment).indices, best.indices);
    EXPECT_TRUE(std::is_sorted(best.adjustments.begin(), best.adjustments.end()));
    EXPECT_TRUE(std::is_permutation(best.indices.begin(), best.indices.end(),
                                    nearest.indices.begin(), nearest.indices.end()));
    for (const Candidates& each : {nearest, best}) {
      for (std::size_t i = 0; i < each.indices.size(); ++i) {
        const std::size_t sample = each.indices[i];
        const auto e = (pose_vector(tip) - pose_vector(database.pose(sample))).eval();
        EXPECT_NEAR(each.distances[i], e.norm(), 1e-9);
        EXPECT_NEAR(each.adjustments[i], (database.pseudo_inverse(sample) * e).norm(),
                    1e-9 * (1 + each.adjustments[i]));
        EXPECT_EQ(each.q[i], database.q(sample));
      }
    }
  }
}

TEST(Selector, WhatFailedDecidesAndNothingElse) {
  const Solver solver = paper_solver("ur3_wrs", [](SolverOptions&) {});
  const iksel::Database& database = solver.database();
  Selector selector(database);
  const Pose target = iksel_test::random_targets(solver.robot(), 1)[0];
  const Candidates best = selector.candidates(of_tip_link(solver.robot(), target));
  const std::size_t kept = 20;
  Indices failed;
  while (failed.size() < kept) {
    const auto next = selector.next(failed);
    ASSERT_TRUE(next);
    // Asked in between about others, in another order.
    EXPECT_EQ(selector.next({}), best.indices[0]);
    ASSERT_TRUE(selector.next({best.indices[7], best.indices[3]}));
    EXPECT_EQ(selector.next(failed), next);
    JointVector sum = JointVector::Zero(database.dof());
    for (const std::size_t each : failed) sum += database.q(each);
    const auto far = [&](std::size_t sample) {
      return (static_cast<double>(failed.size()) * database.q(sample) - sum).norm();
    };
    for (std::size_t i = 0; i < kept && !failed.empty(); ++i) {
      const std::size_t other = best.indices[i];
      if (std::count(failed.begin(), failed.end(), other) > 0) continue;
      EXPECT_LE(far(other), far(*next) + 1e-12) << "after " << failed.size();
    }
    failed.push_back(*next);
  }
  EXPECT_FALSE(selector.next(failed));
}

TEST(Selector, BadInputIsNamed) {
  const Solver solver = paper_solver("ur3_wrs", [](SolverOptions&) {});
  const auto expect_error = [](const auto& call, const std::string& what) {
    try {
      call();
      FAIL() << what;
    } catch (const iksel::InvalidArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  Selector selector(solver.database());
  expect_error([&] { (void)selector.next({}); }, "next: there is no target yet");
  expect_error([&] { selector.rank(Ranking::nearest); }, "rank: there is no target yet");
  expect_error([&] { selector.candidates(Pose::Identity(), 0, Ranking::nearest); }, "count: 0");
  Pose bent = Pose::Identity();
  bent.linear() *= 2;
  expect_error([&] { selector.candidates(bent); }, "pose");
  const Candidates best = selector.candidates(Pose::Identity());
  const std::size_t other = best.indices[50];
  expect_error([&] { (void)selector.next({other}); },
               "failed: sample " + std::to_string(other) + " is none of the 20");
  const std::size_t first = best.indices[0];
  expect_error(
      [&] {
        (void)selector.next({first, first});
      },
      "failed: sample " + std::to_string(first) + " comes twice");
  expect_error([&] { Selector(iksel_test::solver("ur3").database()); }, "key_scheme full");
  Paper scheme;
  scheme.limit_aware = true;
  expect_error([&] { Selector(solver.database(), scheme); }, "limit_aware");
  scheme = {};
  scheme.neighbours = 0;
  expect_error([&] { Selector(solver.database(), scheme); }, "neighbours: 0");
}

}  // namespace
