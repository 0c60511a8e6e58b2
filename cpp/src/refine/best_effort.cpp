// SPDX-License-Identifier: BSD-3-Clause
#include "refine/best_effort.hpp"

#include <cmath>

#include "base/random.hpp"

namespace iksel {

BestEffort::BestEffort(const Goal& goal, double weight) : remainder_(goal, to_vector({}, weight)) {}

JointVector BestEffort::from(const JointVector& seed) {
  JointVector q = seed;
  int steps = 0;
  const double left = descend_from_seed(remainder_, /*most=*/200, q, steps);
  if (left < least_) {
    least_ = left;
    q_ = q;
  }
  return q;
}

bool descend_into_tolerances(const Goal& goal, JointVector& q) {
  /// Weights of the rotation that are tried, each halving what is left between two others.
  constexpr int kRounds = 12;
  /// Logarithms of the least and the largest, where a tolerance counts 1.
  double least = -6;
  double largest = 6;
  const double position_tolerance = goal.task().position_tolerance();
  const double rotation_tolerance = goal.task().rotation_tolerance();
  const JointVector seed = q;
  for (int round = 0; round < kRounds; ++round) {
    const double weight = std::exp(0.5 * (least + largest));
    q = seed;
    int steps = 0;
    // A position counts in metres, a rotation as many as the weight says.
    const Remainder remainder(goal,
                              to_vector({}, weight * position_tolerance / rotation_tolerance));
    // An answer would have come to less than this.
    const double most = 0.5 * (1 + weight * weight) * position_tolerance * position_tolerance;
    if (!(descend_from_seed(remainder, /*most=*/50, q, steps) < most)) return false;
    if (goal.is_solution(q)) return true;
    double position = 0;
    double rotation = 0;
    goal.measure(q, position, rotation);
    const bool is_turned = rotation / rotation_tolerance > position / position_tolerance;
    (is_turned ? least : largest) = 0.5 * (least + largest);
  }
  return false;
}

std::vector<JointVector> BestEffort::from_anywhere(int n, std::uint64_t seed) {
  Random random(seed);
  std::vector<JointVector> ends;
  ends.reserve(static_cast<std::size_t>(n));
  const JointSpace& joints = remainder_.goal().joints();
  for (int i = 0; i < n; ++i) ends.push_back(from(joints.sample(random)));
  return ends;
}

}  // namespace iksel
