// SPDX-License-Identifier: BSD-3-Clause
// Every kind of request to the solvers of one odd chain, at random, and the judgement of each
// answer.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <string>
#include <vector>

#include "odd_questions.hpp"

namespace iksel_test {

inline iksel::DatabaseOptions small_database(Dice& dice) {
  iksel::DatabaseOptions options;
  constexpr std::size_t kSamples[] = {1, 7, 60, 300};
  options.samples = kSamples[dice.pick(4)];
  options.threads = 1;
  return options;
}

/// Requests of every kind to the solvers of one chain.
class Session : private Questions {
 public:
  Session(const OddChain& chain, const iksel::Robot& robot, Dice& dice, Tally& tally)
      : Questions(chain, dice, tally),
        solver_(robot, default_options()),
        paper_(robot, paper_options()) {}

  /// One request; false when there was a finding.
  bool ask() {
    switch (dice_.pick(12)) {
      case 0:
      case 1:
        return solve();
      case 2:
        return near();
      case 3:
        return solve_all();
      case 4:
        return task();
      case 5:
        return objective();
      case 6:
        return seeds();
      case 7:
        return batch();
      case 8:
        return path();
      case 9:
        return paper();
      case 10:
        return track();
      default:
        return dice_.chance(0.3) ? diagnose() : filter();
    }
  }

 private:
  iksel::SolverOptions default_options() {
    iksel::SolverOptions options;
    options.database = small_database(dice_);
    if (chain_.ordinary) options.database.samples = 1000;
    if (dice_.chance(0.1)) options.position_tolerance = 1e-4;
    return options;
  }

  iksel::SolverOptions paper_options() {
    iksel::SolverOptions options = iksel::SolverOptions::paper();
    options.database = small_database(dice_);
    options.database.key_scheme =
        dice_.chance(0.5) ? iksel::KeyScheme::full : iksel::KeyScheme::reduced;
    constexpr iksel::Iteration kSchemes[] = {iksel::Iteration::dls,     iksel::Iteration::pinv,
                                             iksel::Iteration::pinv_rr, iksel::Iteration::cwln,
                                             iksel::Iteration::cwpi,    iksel::Iteration::lm};
    auto& paper = std::get<iksel::Paper>(options.strategy);
    paper.iteration = kSchemes[dice_.pick(6)];
    if (dice_.chance(0.3)) paper.ranking = iksel::Ranking::nearest;
    return options;
  }

  bool solve() {
    const Target target = some_target();
    iksel::SolveRequest request;
    if (dice_.chance(0.3)) request.seeds = {away(some_q())};
    const Result result = solver_.solve(target.pose, request);
    count_reached(target, result);
    return take("solve", solver_.options(), {}, target, result);
  }

  bool near() {
    const JointVector q = some_q();
    const Target target = dice_.chance(0.8) ? Target{pose_of(q), true} : some_target();
    iksel::SolveRequest request;
    request.near = away(q);
    if (dice_.chance(0.5)) request.weights = some_weights();
    if (dice_.chance(0.5)) request.norm = iksel::MoveNorm::max;
    if (dice_.chance(0.1)) request.deadline = 1e-4;
    const Result result = solver_.solve(target.pose, request);
    if (std::isinf(request.deadline)) count_reached(target, result);
    if (!take("near", solver_.options(), {}, target, result)) return false;
    if (!result.success()) return true;
    JointVector move = (result.q - *request.near).cwiseAbs();
    if (request.weights.size() > 0) move = move.cwiseProduct(request.weights);
    const double length = request.norm == iksel::MoveNorm::max ? move.maxCoeff() : move.norm();
    EXPECT_NEAR(result.move, length, 1e-9 * (1 + length));
    return !testing::Test::HasFailure();
  }

  bool solve_all() {
    const Target target = some_target();
    iksel::SolveAllOptions options;
    options.max = 1 + dice_.pick(64);
    options.whole_turns = dice_.chance(0.3);
    const iksel::Solutions found = solver_.solve_all(target.pose, options);
    ++tally_.cases;
    tally_.solved += found.success() ? 1 : 0;
    EXPECT_EQ(found.success(), !found.all.empty());
    EXPECT_LE(found.all.size(), static_cast<std::size_t>(options.max));
    for (const Result& one : found.all) {
      EXPECT_TRUE(one.success());
      if (!holds("solve_all", solver_.options(), {}, target, one.q)) return false;
    }
    return !testing::Test::HasFailure();
  }

  bool task() {
    const Target target = some_target();
    OddGoal goal;
    goal.kind = static_cast<OddTask>(1 + dice_.pick(5));
    goal.axis = dice_.pick(3);
    goal.position_width = dice_.uniform(0, 0.1) * chain_.scale;
    goal.rotation_width = dice_.uniform(0, 1.5);
    iksel::SolveRequest request;
    request.task = goal.task();
    if (dice_.chance(0.3)) request.near = away(some_q());
    return take("task", solver_.options(), goal, target, solver_.solve(target.pose, request));
  }

  bool objective() {
    const Target target = some_target();
    iksel::SolveRequest request;
    switch (dice_.pick(4)) {
      case 0:
        request.objective = iksel::Objective::near_posture(some_q(), some_weights());
        break;
      case 1:
        request.objective = iksel::Objective::far_from_limits();
        break;
      case 2:
        request.objective = iksel::Objective::most_manipulable();
        break;
      default:
        request.objective =
            iksel::Objective::custom([](const JointVector& q) { return std::sin(q.sum()); });
    }
    return take("objective", solver_.options(), {}, target, solver_.solve(target.pose, request));
  }

  bool seeds() {
    const Target target = some_target();
    iksel::SolveRequest request;
    const int n = dice_.pick(6);
    for (int i = 0; i < n; ++i) request.seeds.push_back(away(some_q()));
    request.database_seeds = n == 0 || dice_.chance(0.5);
    const iksel::Solver& solver = dice_.chance(0.3) ? paper_ : solver_;
    return take("seeds", solver.options(), {}, target, solver.solve(target.pose, request));
  }

  bool batch() {
    std::vector<Target> targets;
    std::vector<Pose> poses;
    std::vector<JointVector> near;
    iksel::SolveRequest request;
    const int n = 1 + dice_.pick(12);
    const bool wishes = dice_.chance(0.3);
    for (int i = 0; i < n; ++i) {
      targets.push_back(some_target());
      poses.push_back(targets.back().pose);
      if (wishes) near.push_back(away(some_q()));
    }
    const std::vector<Result> results = wishes ? solver_.solve_batch(poses, request, near, 1)
                                               : solver_.solve_batch(poses, {}, {}, 1);
    EXPECT_EQ(results.size(), poses.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
      count_reached(targets[i], results[i]);
      if (!take("batch", solver_.options(), {}, targets[i], results[i])) return false;
    }
    return true;
  }

  bool path() {
    const std::vector<JointVector> q = line(2 + dice_.pick(5));
    std::vector<Pose> poses;
    for (const JointVector& one : q) poses.push_back(pose_of(one));
    iksel::PathOptions options;
    if (dice_.chance(0.5)) options.start = q.front();
    if (dice_.chance(0.5)) options.dt = dice_.uniform(0.1, 3);
    options.candidates = 1 + dice_.pick(16);
    const iksel::PathResult result = solver_.solve_path(poses, options);
    ++tally_.cases;
    tally_.solved += result.success() ? 1 : 0;
    EXPECT_EQ(result.success(), result.q.size() == poses.size());
    for (std::size_t i = 0; i < result.q.size(); ++i) {
      if (!holds("path", solver_.options(), {}, {poses[i], true}, result.q[i])) return false;
      if (options.dt > 0 && i > 0) {
        EXPECT_TRUE(step_is_slow_enough(result.q[i - 1], result.q[i], options.dt)) << "path";
      }
    }
    return !testing::Test::HasFailure();
  }

  bool paper() {
    const Target target = some_target();
    return take("paper", paper_.options(), {}, target, paper_.solve(target.pose));
  }

  bool track() {
    const std::vector<JointVector> q = line(6);
    iksel::Tracker tracker(solver_, dice_.chance(0.2) ? away(q[0]) : q[0]);
    for (const JointVector& next : q) {
      const Target target = dice_.chance(0.8) ? Target{pose_of(next), true} : some_target();
      const JointVector before = tracker.q();
      const double dt = dice_.uniform(0.001, 1);
      const Result result = tracker.track(target.pose, dt);
      ++tally_.cases;
      std::string why;
      // From outside it comes back as fast as the joints may move.
      if (inside_limits(chain_, before, why)) {
        EXPECT_TRUE(inside_limits(chain_, tracker.q(), why)) << "tracker: " << why;
      }
      EXPECT_TRUE(step_is_slow_enough(before, tracker.q(), dt)) << "tracker";
      if (result.success()) {
        ++tally_.solved;
        if (!holds("track", solver_.options(), {}, target, result.q)) return false;
      }
    }
    return !testing::Test::HasFailure();
  }

  bool diagnose() {
    const Target target = some_target();
    const iksel::Diagnosis found = solver_.diagnose(target.pose);
    ++tally_.cases;
    tally_.solved += found.q_is_solution ? 1 : 0;
    return !found.q_is_solution || holds("diagnose", solver_.options(), {}, target, found.q);
  }

  bool filter() {
    const Target target = some_target();
    const double middle = some_q()[0];
    iksel::SolveRequest request;
    request.filter =
        iksel::filter_each(chain_.dof(), [middle](const JointVector& q) { return q[0] >= middle; });
    const Result result = solver_.solve(target.pose, request);
    if (result.success()) EXPECT_GE(result.q[0], middle);
    return take("filter", solver_.options(), {}, target, result);
  }

  iksel::Solver solver_;
  iksel::Solver paper_;
};

}  // namespace iksel_test
