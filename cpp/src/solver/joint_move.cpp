// SPDX-License-Identifier: BSD-3-Clause
#include "solver/joint_move.hpp"

#include <algorithm>
#include <cmath>

namespace iksel {

bool take_nearest_turns(const ChainModel& model, const JointVector& near, double slack,
                        JointVector& q) {
  bool held = false;
  for (int j = 0; j < model.dof; ++j) {
    if (!has_whole_turns(model, j)) continue;
    const double lower = model.lower[j] - slack;
    const double upper = model.upper[j] + slack;
    double value = q[j];
    if (std::abs(near[j] - value) > kPi) value += kTwoPi * std::round((near[j] - value) / kTwoPi);
    // The nearest turn of all lies outside: then the nearest inside.
    if (value > upper) value -= kTwoPi * std::ceil((value - upper) / kTwoPi);
    if (value < lower) value += kTwoPi * std::ceil((lower - value) / kTwoPi);
    if (value < lower || value > upper) continue;
    q[j] = std::min(std::max(value, model.lower[j]), model.upper[j]);
    held = held || q[j] != value;
  }
  return held;
}

void take_first_turns(const ChainModel& model, JointVector& q) {
  for (int j = 0; j < model.dof; ++j) {
    if (!has_whole_turns(model, j)) continue;
    const double lower = std::isfinite(model.lower[j]) ? model.lower[j] : -kPi;
    double value = q[j] - kTwoPi * std::floor((q[j] - lower) / kTwoPi);
    if (value < lower) value += kTwoPi;
    if (value <= model.upper[j]) q[j] = value;
  }
}

bool take_next_turns(const ChainModel& model, JointVector& q) {
  for (int j = 0; j < model.dof; ++j) {
    // A joint without limits has no end of turns; one copy stands for all.
    if (!has_whole_turns(model, j) || !std::isfinite(model.upper[j])) continue;
    if (q[j] + kTwoPi <= model.upper[j]) {
      q[j] += kTwoPi;
      return true;
    }
    q[j] -= kTwoPi * std::floor((q[j] - model.lower[j]) / kTwoPi);
    if (q[j] < model.lower[j]) q[j] += kTwoPi;
  }
  return false;
}

JointVector middle_of_limits(const ChainModel& model) {
  JointVector middle(model.dof);
  for (int j = 0; j < model.dof; ++j) {
    const double m = (model.lower[j] + model.upper[j]) / 2;
    middle[j] = std::isfinite(m) ? m : 0.0;
  }
  return middle;
}

}  // namespace iksel
