// SPDX-License-Identifier: BSD-3-Clause
// Seeds at random: uniform inside the limits, or around a configuration.
#pragma once

#include <cstdint>

#include "base/random.hpp"
#include "base/work.hpp"
#include "kinematics/joint_space.hpp"

namespace iksel {

/// Starts a lane at random.
template <typename Refiner>
void load_random(const JointSpace& joints, Random& random, Refiner& refiner, int lane) {
  refiner.load_seed(lane, joints.sample(random).data());
}

/// Around a configuration: what is nearest to it, of solutions with many joints to spare, is found
/// from there rather than from all over the limits.
class NearbySeeds {
 public:
  /// So many of them for one tip, on top of those that `work` allows.
  static constexpr int kCount = 64;
  /// Each joint is at most so far away [rad or m]. Of 0.5, 1 and 1.7, 1 gave the shortest moves of
  /// two arms as one chain.
  static constexpr double kFarthest = 1;

  /// All must outlive this.
  NearbySeeds(const JointVector& from, std::uint64_t seed, Work& work, int count = kCount)
      : from_(from), random_(seed), work_(work), left_(count) {}

  [[nodiscard]] bool next_stage() const { return left_ > 0; }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (left_ == 0) return false;
    --left_;
    work_.take_guess();
    double q[kMaxDof];
    for (Eigen::Index j = 0; j < from_.size(); ++j) {
      q[j] = from_[j] + random_.uniform(-kFarthest, kFarthest);
    }
    refiner.load_seed(lane, q);
    return true;
  }

 private:
  const JointVector& from_;
  Random random_;
  Work& work_;
  int left_;
};

}  // namespace iksel
