// SPDX-License-Identifier: BSD-3-Clause
// Seeds of a goal that has no answer: many are moved towards where the least is missing, in single
// precision and many abreast, and of those that come nearest some go on.
#pragma once

#include <vector>

#include "base/random.hpp"
#include "goal/goal.hpp"
#include "kinematics/chain_model.hpp"
#include "seeds/lane_query.hpp"
#include "simd/kernels.hpp"

namespace iksel {

class ClosestScreen {
 public:
  /// Of weights [1/m, 1/rad] the largest of position and rotation count.
  ClosestScreen(const ChainModel& model, const Vector6& weights);

  /// Where seeds of the goal came to, the nearest first: from samples of the database near the
  /// target, and at random. Of a task, each pack of seeds heads for another pose that it allows.
  const std::vector<JointVector>& find(const Goal& goal, LaneQuery& query, Random& random);
  /// Seeds that find() moves.
  static int count();

 private:
  /// A seed, `number` its place in `joints_`.
  struct Seed {
    float remainder;
    unsigned number;
    unsigned target;
  };

  template <typename Value>
  void load(int place, const Value& value);
  /// Moves what was loaded, towards one of the targets.
  void run(std::size_t target, int iterations);
  /// Keeps that many seeds, the best first.
  void keep(std::size_t count);
  /// Moves those that are left farther.
  void go_on(int iterations);
  [[nodiscard]] const float* values_of(const Seed& seed) const {
    return joints_.data() + seed.number * static_cast<std::size_t>(chain_.n);
  }
  [[nodiscard]] JointVector joints_of(const Seed& seed) const;

  const ChainModel& model_;
  lanes::Approach approach_;
  double length_;  ///< that 1 unit of the lanes is [m]
  float position_, rotation_;
  lanes::LaneChainOf<float> chain_;
  lanes::RoughPack pack_{};
  std::vector<Pose> targets_;  ///< Y (reduction.hpp)
  std::vector<Seed> seeds_;
  std::vector<float> joints_;  ///< of all seeds so far, as the lanes have them
  std::vector<JointVector> found_;
};

}  // namespace iksel
