// SPDX-License-Identifier: BSD-3-Clause
#include "refine/best_effort.hpp"

#include "base/random.hpp"

namespace iksel {
namespace {

Vector6 weights_of(double rotation) {
  Vector6 weights;
  weights << 1, 1, 1, rotation, rotation, rotation;
  return weights;
}

}  // namespace

BestEffort::BestEffort(const ChainModel& model, const Goal& goal, double weight)
    : model_(model), remainder_(model, goal, weights_of(weight)) {}

JointVector BestEffort::from(const JointVector& seed) {
  constexpr int kSteps = 200;
  JointVector q = seed;
  int steps = 0;
  const double left = descend_from_seed(model_, remainder_, kSteps, q, steps);
  if (left < least_) {
    least_ = left;
    q_ = q;
  }
  return q;
}

std::vector<JointVector> BestEffort::from_anywhere(int n, std::uint64_t seed) {
  Random random(seed);
  JointVector q(model_.dof);
  std::vector<JointVector> ends;
  for (int i = 0; i < n; ++i) {
    model_.joints.sample(random, q);
    ends.push_back(from(q));
  }
  return ends;
}

}  // namespace iksel
