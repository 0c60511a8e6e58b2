// SPDX-License-Identifier: BSD-3-Clause
#include "solver/joint_move.hpp"

#include <algorithm>
#include <cmath>

namespace iksel {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;

}  // namespace

void take_nearest_turns(const ChainModel& model, const JointVector& near, JointVector& q) {
  for (int j = 0; j < model.dof; ++j) {
    if (!has_whole_turns(model, j)) continue;
    double value = q[j] + kTwoPi * std::round((near[j] - q[j]) / kTwoPi);
    // One turn to either side is as near or nearer only if this one lies outside.
    if (value > model.upper[j]) value -= kTwoPi * std::ceil((value - model.upper[j]) / kTwoPi);
    if (value < model.lower[j]) value += kTwoPi * std::ceil((model.lower[j] - value) / kTwoPi);
    if (value >= model.lower[j] && value <= model.upper[j]) q[j] = value;
  }
}

void take_first_turns(const ChainModel& model, JointVector& q) {
  constexpr double kPi = kTwoPi / 2;
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

double distance_without_turns(const ChainModel& model, const double* a, const double* b) {
  double largest = 0;
  for (int j = 0; j < model.dof; ++j) {
    double d = a[j] - b[j];
    if (has_whole_turns(model, j)) d = std::remainder(d, kTwoPi);
    largest = std::max(largest, std::abs(d));
  }
  return largest;
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
