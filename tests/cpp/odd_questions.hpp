// SPDX-License-Identifier: BSD-3-Clause
// What is asked of the solvers of an odd chain: random targets, seeds and lines; and the judgement
// of the answers.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <string>
#include <vector>

#include "odd_judge.hpp"
#include "odd_maker.hpp"

namespace iksel_test {

using iksel::JointVector;
using iksel::Pose;
using iksel::Result;
using iksel::Status;

struct Tally {
  int cases = 0;
  int solved = 0;
  int reachable = 0;  ///< full poses that ordinary chains do reach, by requests that search for all
  int reached = 0;
};

/// Draws questions about one chain, and counts and judges the answers.
class Questions {
 public:
  Questions(const OddChain& chain, Dice& dice, Tally& tally)
      : chain_(chain), dice_(dice), tally_(tally) {}

 protected:
  struct Target {
    Pose pose;
    bool reachable;
  };

  Pose pose_of(const JointVector& q) const {
    Pose pose = Pose::Identity();
    pose.matrix() = forward(chain_, q).matrix().cast<double>();
    return pose;
  }

  JointVector some_q() {
    JointVector q = random_q(chain_, dice_);
    // Sometimes on limits, sometimes where axes line up.
    const int kind = dice_.pick(10);
    for (int j = 0; j < q.size() && kind < 2; ++j) {
      const auto v = static_cast<std::size_t>(j);
      if (kind == 0 && std::isfinite(chain_.lower[v]) && dice_.chance(0.5)) q[j] = chain_.lower[v];
      if (kind == 1) q[j] = std::min(std::max(0.0, chain_.lower[v]), chain_.upper[v]);
    }
    return q;
  }

  Target some_target() {
    if (dice_.chance(0.7)) return {pose_of(some_q()), true};
    Pose pose = pose_of(random_q(chain_, dice_));
    if (dice_.chance(0.5)) {
      pose.linear() = rotation_of_rpy<double>(dice_.vector(3));
    } else {
      pose.translation() += dice_.vector(chain_.scale * (dice_.chance(0.5) ? 0.01 : 10));
    }
    return {pose, false};
  }

  /// Somewhere near q, or a good way outside of the limits.
  JointVector away(JointVector q) {
    const double largest = dice_.chance(0.2) ? 50 : 0.3;
    for (int j = 0; j < q.size(); ++j) {
      q[j] += dice_.uniform(-largest, largest);
      const auto variable = static_cast<std::size_t>(chain_.variables[static_cast<std::size_t>(j)]);
      if (chain_.joints[variable].type == iksel::JointType::prismatic) continue;
      // Of a long arm larger angles are refused.
      q[j] = std::max(-100.0, std::min(100.0, q[j]));
    }
    return q;
  }

  JointVector some_weights() {
    JointVector weights(chain_.dof());
    for (double& w : weights) w = dice_.uniform(0.01, 2);
    return weights;
  }

  /// Joint values a step of the line from a to b apart, inside the limits.
  std::vector<JointVector> line(int n) {
    const JointVector a = some_q();
    const JointVector b = some_q();
    std::vector<JointVector> q;
    for (int i = 0; i < n; ++i) {
      q.push_back(a + (b - a) * (0.02 * i));
      for (int j = 0; j < a.size(); ++j) {
        const auto v = static_cast<std::size_t>(j);
        q.back()[j] = std::min(std::max(q.back()[j], chain_.lower[v]), chain_.upper[v]);
      }
    }
    return q;
  }

  bool step_is_slow_enough(const JointVector& from, const JointVector& to, double dt) const {
    for (int j = 0; j < to.size(); ++j) {
      const auto v = static_cast<std::size_t>(chain_.variables[static_cast<std::size_t>(j)]);
      const double most = chain_.joints[v].velocity * dt;
      const double digits = 1e-14 * (1 + std::abs(from[j]) + std::abs(to[j]));
      if (std::abs(to[j] - from[j]) > most * (1 + 1e-9) + digits) return false;
    }
    return true;
  }

  /// Counts an answer, and reports what is wrong with it.
  bool take(const char* request, const iksel::SolverOptions& options, const OddGoal& goal,
            const Target& target, const Result& result) {
    ++tally_.cases;
    if (!result.success()) {
      // Reach is a bound: a pose that can be reached is never beyond it.
      EXPECT_FALSE(target.reachable && result.status == Status::out_of_reach) << request;
      EXPECT_EQ(result.q.size(), 0) << request;
      return !testing::Test::HasFailure();
    }
    ++tally_.solved;
    return holds(request, options, goal, target, result.q);
  }

  bool holds(const char* request, const iksel::SolverOptions& options, const OddGoal& goal,
             const Target& target, const JointVector& q) {
    const std::string wrong = judge(chain_, options, goal, target.pose, q);
    EXPECT_EQ(wrong, "") << "a false success of " << request << ": " << q.transpose();
    return wrong.empty();
  }

  void count_reached(const Target& target, const Result& result) {
    if (!chain_.ordinary || !target.reachable) return;
    ++tally_.reachable;
    tally_.reached += result.success() ? 1 : 0;
  }

  const OddChain& chain_;
  Dice& dice_;
  Tally& tally_;
};

}  // namespace iksel_test
