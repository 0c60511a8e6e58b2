// SPDX-License-Identifier: BSD-3-Clause
// The least error inside the limits, for a task that has no answer there.
#pragma once

#include <cstdint>
#include <vector>

#include "base/constants.hpp"
#include "goal/goal.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

class BestEffort {
 public:
  /// `weight` is the length that 1 rad counts [m].
  BestEffort(const ChainModel& model, const Goal& goal, double weight)
      : model_(model), goal_(goal), weight_(weight) {}

  /// Makes 1 rad count that part of what it counts otherwise. To come first.
  void weigh_rotation(double part) { weight_ *= part; }

  /// Where it ended.
  JointVector from(const JointVector& seed);
  /// From n configurations spread over the limits by a seed.
  std::vector<JointVector> from_anywhere(int n, std::uint64_t seed);
  [[nodiscard]] const JointVector& q() const { return q_; }

 private:
  /// What is left of both errors [m].
  [[nodiscard]] double error_of(const JointVector& q) const;

  const ChainModel& model_;
  const Goal& goal_;
  double weight_;
  double error_ = kInfinity;
  JointVector q_;
};

}  // namespace iksel
