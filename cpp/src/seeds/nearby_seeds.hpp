// SPDX-License-Identifier: BSD-3-Clause
// Seeds around a configuration: what is nearest to it, of solutions with many joints to spare, is
// found from there rather than from all over the limits.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/random.hpp"
#include "base/work.hpp"
#include "kinematics/joint_space.hpp"

namespace iksel {

class NearbySeeds {
 public:
  /// So many of them for one tip, on top of those that `work` allows.
  static constexpr int kCount = 64;
  /// Each joint is at most so far away [rad or m]. Of 0.5, 1 and 1.7, 1 gave the shortest moves of
  /// two arms as one chain.
  static constexpr double kFarthest = 1;

  /// All must outlive this.
  NearbySeeds(const JointSpace& joints, const JointVector& from, std::uint64_t seed, Work& work,
              int count = kCount)
      : joints_(joints), from_(from), random_(seed), work_(work), count_(count) {}

  [[nodiscard]] bool next_stage() const { return loaded_ == 0; }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (loaded_ == count_) return false;
    ++loaded_;
    work_.take_guess();
    double q[kMaxDof];
    for (int j = 0; j < joints_.dof(); ++j) {
      q[j] = from_[j] + random_.uniform(-kFarthest, kFarthest);
    }
    refiner.load_seed(lane, q);
    return true;
  }

 private:
  const JointSpace& joints_;
  const JointVector& from_;
  Random random_;
  Work& work_;
  int count_;
  int loaded_ = 0;
};

}  // namespace iksel
