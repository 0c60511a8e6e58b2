// SPDX-License-Identifier: BSD-3-Clause
// What a baseline is given: a chain, its limits, targets and starts. Metres and radians.
#pragma once

#include <cstdint>
#include <kdl/chain.hpp>
#include <kdl/frames.hpp>
#include <kdl/jntarray.hpp>
#include <random>
#include <string>
#include <vector>

namespace baselines {

struct Problem {
  KDL::Chain chain;
  /// Infinite for continuous joints.
  KDL::JntArray lower, upper;
  /// T_base_tip of each target.
  std::vector<KDL::Frame> targets;
  /// Where the search for each target begins.
  std::vector<KDL::JntArray> starts;

  [[nodiscard]] unsigned dof() const { return lower.rows(); }
};

/// Reads the text that bench/rivals/kdl.py writes: dof; dof + 1 constant transforms (row-major
/// 3x4); per joint prismatic (0 or 1), lower and upper limit; the number of targets; per target a
/// transform and a start. Throws std::runtime_error.
Problem read_problem(const std::string& path);

/// Configurations uniform inside the limits; continuous joints in [-pi, pi).
class RandomStart {
 public:
  RandomStart(const Problem& problem, std::uint64_t seed) : problem_(problem), engine_(seed) {}
  void draw(KDL::JntArray& q);

 private:
  const Problem& problem_;
  std::mt19937_64 engine_;
};

/// Brings revolute joints inside their limits by whole turns where that is possible; whether q then
/// lies inside all limits.
bool wrap_into_limits(const Problem& problem, KDL::JntArray& q);

/// Whether the tip is within `tolerance` of the target, in [m] and in [rad].
bool reached(const KDL::Twist& error, double tolerance);

}  // namespace baselines
