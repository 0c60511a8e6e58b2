// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace iksel {

Sweep::Sweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
             double tolerance, const lanes::LaneKernels& kernels)
    : branches_(model, chain, kernels),
      places_(branches_.places(kSamples)),
      miss_(is_nominal, tolerance),
      rows_(kSamples) {}

bool Sweep::find(const Pose& Y) {
  set_target(Y);
  for (int pack = 0; pack < kPacks; ++pack) {
    // Far from each other first, so that an answer is soon found.
    constexpr int kStride = 5;
    static_assert(std::gcd(kStride, kPacks) == 1, "each pack once");
    const int first = pack * kStride % kPacks * kBranches;
    SweptBranches::Row* rows = &rows_[static_cast<std::size_t>(first)];
    branches_.rate([&](int i) { return places_.value(first + i); }, kNear, rows);
    for (int i = 0; i < kBranches; ++i) {
      if (take_answer(first + i)) return true;
    }
  }
  nearest_.find(places_, rows_, kNear);
  least_ = kInfinity;
  close_.clear();
  for (const LeastPlace& near : nearest_) {
    least_ = std::min(least_, near.value);
    if (follow(near)) return true;
  }
  return false;
}

bool Sweep::take_answer(int place) {
  const SweptBranches::Row& off = rows_[static_cast<std::size_t>(place)];
  const auto best = std::min_element(off.begin(), off.end());
  if (*best > 0) return false;
  branches_.solve_all(places_.value(place));
  branch_ = static_cast<int>(best - off.begin());
  branches_.copy_joints(branch_, q_.data());
  return true;
}

void Sweep::add_samples(const Pose& Y, int first, int stride, std::vector<double>& q) {
  std::vector<Sample> samples;
  set_target(Y);
  add_samples(first, stride, q, samples);
}

void Sweep::add_samples(int first, int stride, std::vector<double>& q,
                        std::vector<Sample>& samples) {
  for (int place = first; place < kSamples; place += stride) {
    branches_.solve_all(places_.value(place));
    for (int lane = 0; lane < kBranches; ++lane) {
      if (branches_.off(lane) > 0) continue;
      branches_.copy_joints(lane, q_.data());
      q.insert(q.end(), q_.begin(), q_.end());
      samples.push_back({place, lane});
    }
  }
}

void Sweep::add_beside(const double* from, int branch, std::vector<double>& q) {
  // Without the middle and the ends, which are samples.
  constexpr double kHalf = (kBranches + 2) / 2.0;
  const double middle = from[branches_.joint()];
  branches_.solve_one(branch, [&](int lane) {
    const int place = lane < kBranches / 2 ? lane + 1 : lane + 2;
    return branches_.clamp(middle + places_.step * (place - kHalf) / kHalf);
  });
  for (int lane = 0; lane < kBranches; ++lane) {
    if (branches_.off(lane) > 0) continue;
    branches_.copy_joints(lane, q_.data());
    q.insert(q.end(), q_.begin(), q_.end());
  }
}

bool Sweep::follow(const LeastPlace& near) {
  constexpr int kRounds = 8;
  // Of 4,491 answers found so, of five arms, none was farther off after one round, two and three
  // than 0.09, 0.03 and 0.015.
  constexpr std::array<double, 3> kHopeless{0.2, 0.1, 0.05};
  const auto value = [&](double place) { return branches_.clamp(place); };
  const auto off = [&](int lane) { return branches_.off(lane); };
  SweptJoints best{kInfinity, {}};
  const auto take = [&](int lane, double) { branches_.copy_joints(lane, best.q.data()); };
  const auto is_enough = [&](double least, int round) {
    if (least <= 0) return true;
    const std::size_t looked = std::min(static_cast<std::size_t>(round), kHopeless.size());
    return looked > 0 && least > kHopeless[looked - 1];
  };
  const Bracket bracket{near.branch, places_.value(near.place), places_.step, kRounds};
  best.value = minimize(branches_, bracket, value, off, kInfinity, take, is_enough);
  least_ = std::min(least_, best.value);
  if (miss_.is_close(best.value)) close_.add(best);
  if (best.value > 0) return false;
  q_ = best.q;
  branch_ = near.branch;
  return true;
}

}  // namespace iksel
