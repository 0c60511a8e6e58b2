// SPDX-License-Identifier: BSD-3-Clause
// Seeds at random: uniform inside the limits, or around a configuration.
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.hpp"
#include "kinematics/joint_space.hpp"

namespace iksel {

/// Starts a lane at random.
template <typename Refiner>
void load_random(const JointSpace& joints, Random& random, Refiner& refiner, int lane) {
  refiner.load_seed(lane, joints.sample(random).data());
}

/// So many rows around a configuration.
inline constexpr int kNearby = 64;

/// `count` rows around a configuration: what is nearest to it, of solutions with many joints to
/// spare, is found from there rather than from all over the limits.
inline std::vector<double> sample_around(const JointVector& from, std::uint64_t seed, int count) {
  /// Each joint is at most so far away [rad or m]. Of 0.5, 1 and 1.7, 1 gave the shortest moves of
  /// two arms as one chain.
  constexpr double kFarthest = 1;
  Random random(seed);
  std::vector<double> q;
  for (int i = 0; i < count; ++i) {
    for (const double value : from) q.push_back(value + random.uniform(-kFarthest, kFarthest));
  }
  return q;
}

}  // namespace iksel
