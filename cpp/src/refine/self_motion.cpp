// SPDX-License-Identifier: BSD-3-Clause
#include "refine/self_motion.hpp"

#include <algorithm>

#include "base/constants.hpp"
#include "iksel/options.hpp"
#include "refine/least_cost_step.hpp"
#include "refine/limited_step.hpp"

namespace iksel {
namespace {

// `Linear`: six rows, or six for each of several tips.

template <typename Linear>
bool converge_rows(const Goal& goal, int most, double aim, bool wraps, JointVector& q, int& steps) {
  const double damping = Lanes{}.damping;
  const JointSpace& joints = goal.joints();
  Linear at;
  for (int step = 0;; ++step) {
    goal.linearize(q, /*exact=*/false, at);
    if (goal.is_reached(at.missing, step == most ? 1 : aim)) {
      if (wraps) joints.wrap(q.data());
      return joints.contains(q.data());
    }
    if (step == most) return false;
    at.to_unit(goal.unit());
    const double damped_by = damping * at.missing.squaredNorm();
    const JointVector adjustment = step_into_bounds(at, [&](const auto& rows, const auto& asked) {
      return lm_step(joints, goal.unit(), q, rows, asked, damped_by, wraps);
    });
    ++steps;
    if (!adjustment.allFinite()) return false;
    q += adjustment;
  }
}

template <typename Linear>
int descend_rows(const Goal& goal, const JointCost& cost, int most, JointVector& q) {
  constexpr double kSettled = 1e-7;
  const JointSpace& joints = goal.joints();
  JointVector gradient(joints.dof());
  JointVector curvature(joints.dof());
  Linear at;
  double value = cost(q, &gradient, &curvature);
  int steps = 0;
  while (steps < most) {
    goal.linearize(q, /*exact=*/true, at);
    const JointVector step = least_cost_step(joints, q, at, gradient, curvature);
    const double longest = step.cwiseAbs().maxCoeff();
    if (!(longest > kSettled)) return steps;
    double scale = std::min(1.0, kLongestStep / longest);
    bool better = false;
    for (int halving = 0; halving < 8 && !better; ++halving, scale /= 2) {
      JointVector next = joints.clamp(q + scale * step);
      int corrections = 0;
      if (!converge_rows<Linear>(goal, /*most=*/8, kWellInside, /*wraps=*/false, next,
                                 corrections)) {
        continue;
      }
      const double next_value = cost(next, nullptr, nullptr);
      if (!(next_value < value)) continue;
      better = true;
      q = next;
    }
    ++steps;
    if (!better) return steps;
    value = cost(q, &gradient, &curvature);
  }
  return steps;
}

}  // namespace

bool converge(const Goal& goal, int most, JointVector& q, int& steps, double aim, bool wraps) {
  return goal.tips() == nullptr ? converge_rows<Goal::Linear>(goal, most, aim, wraps, q, steps)
                                : converge_rows<TipsGoal::Linear>(goal, most, aim, wraps, q, steps);
}

int descend_self_motion(const Goal& goal, const JointCost& cost, int most, JointVector& q) {
  return goal.tips() == nullptr ? descend_rows<Goal::Linear>(goal, cost, most, q)
                                : descend_rows<TipsGoal::Linear>(goal, cost, most, q);
}

int descend_to_near(const Goal& goal, const JointMove& move, const JointVector& near,
                    JointVector& q) {
  int steps = 0;
  const auto descend = [&](double power) {
    const MoveCost cost(move.weights(), near, power);
    steps += descend_self_motion(goal, JointCost(cost), /*most=*/20, q);
  };
  descend(2);
  if (move.norm() == MoveNorm::two) return steps;
  JointVector best = q;
  // The p-norm tends to the max norm; each is easy to reach from the one before.
  for (const double power : {4.0, 16.0, 64.0}) {
    descend(power);
    if (move.length(q - near) < move.length(best - near)) best = q;
  }
  q = best;
  return steps;
}

int descend_in_time(const Goal& goal, const JointVector& longest, const JointVector& from,
                    JointVector& q) {
  return descend_to_near(goal, JointMove(weights_of_time(longest), MoveNorm::max), from, q);
}

}  // namespace iksel
