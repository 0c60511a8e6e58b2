// SPDX-License-Identifier: BSD-3-Clause
// Seeds at random, uniform inside the limits.
#pragma once

#include <cstdint>
#include <limits>

#include "base/random.hpp"
#include "base/work.hpp"
#include "kinematics/joint_space.hpp"

namespace iksel {

/// Starts a lane at random.
template <typename Refiner>
void load_random(const JointSpace& joints, Random& random, Refiner& refiner, int lane) {
  double q[kMaxDof];
  joints.sample(random, q);
  refiner.load_seed(lane, q);
}

class RandomSeeds {
 public:
  RandomSeeds(const JointSpace& joints, std::uint64_t seed, Work& work,
              int per_stage = std::numeric_limits<int>::max())
      : joints_(joints), random_(seed), work_(work), per_stage_(per_stage) {}

  bool next_stage() {
    in_stage_ = 0;
    return work_.has_left();
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (in_stage_ == per_stage_ || !work_.take()) return false;
    ++in_stage_;
    load_random(joints_, random_, refiner, lane);
    return true;
  }

 private:
  const JointSpace& joints_;
  Random random_;
  Work& work_;
  int per_stage_;
  int in_stage_ = 0;
};

}  // namespace iksel
