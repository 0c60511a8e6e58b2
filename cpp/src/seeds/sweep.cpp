// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/sweep.hpp"

#include <algorithm>
#include <cmath>

namespace iksel {

Sweep::Sweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
             double tolerance, const lanes::LaneKernels& kernels)
    : branches_(model, chain, kernels),
      places_(branches_.places(kSamples)),
      miss_(is_nominal, tolerance),
      rows_(kSamples) {}

bool Sweep::find(const Pose& Y) {
  branches_.set_target(Y);
  for (int k = 0; k < kSamples; ++k) {
    // Far from each other first, so that an answer is soon found; coprime to the number of samples.
    constexpr int kStride = 19;
    const int place = k * kStride % kSamples;
    branches_.solve_all(places_.value(place));
    SweptBranches::Row& off = rows_[static_cast<std::size_t>(place)];
    for (int lane = 0; lane < kBranches; ++lane) {
      off[static_cast<std::size_t>(lane)] = branches_.off(lane);
    }
    const auto best = std::min_element(off.begin(), off.end());
    if (*best > 0) continue;
    branches_.copy_joints(static_cast<int>(best - off.begin()), q_.data());
    return true;
  }
  nearest_.find(places_, rows_, kNear);
  least_ = kInfinity;
  for (const LeastPlace& near : nearest_) {
    least_ = std::min(least_, near.value);
    if (follow(near)) return true;
  }
  return false;
}

void Sweep::add_samples(const Pose& Y, int first, int stride, std::vector<double>& q) {
  branches_.set_target(Y);
  for (int place = first; place < kSamples; place += stride) {
    branches_.solve_all(places_.value(place));
    for (int lane = 0; lane < kBranches; ++lane) {
      if (branches_.off(lane) > 0) continue;
      branches_.copy_joints(lane, q_.data());
      q.insert(q.end(), q_.begin(), q_.end());
    }
  }
}

bool Sweep::follow(const LeastPlace& near) {
  constexpr int kRounds = 4;
  const auto value = [&](double place) { return branches_.clamp(place); };
  const auto off = [&](int lane) { return branches_.off(lane); };
  const auto take = [&](int lane, double) { branches_.copy_joints(lane, q_.data()); };
  const auto is_there = [](double least, int) { return least <= 0; };
  const Bracket bracket{near.branch, places_.value(near.place), places_.step, kRounds};
  const double least = minimize(branches_, bracket, value, off, kInfinity, take, is_there);
  least_ = std::min(least_, least);
  return least <= 0;
}

}  // namespace iksel
