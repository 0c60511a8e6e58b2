// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/constants.hpp"

namespace iksel {

Sweep::Sweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
             double tolerance, const lanes::LaneKernels& kernels)
    : chain_(chain),
      kernels_(kernels),
      concludes_(is_nominal && tolerance <= kMostTolerance),
      close_(std::max(0.01, 4 * std::sqrt(2 * tolerance))),
      lower_(model.joints.sample_lower(chain.held)),
      offset_(model.kernel.joints[static_cast<std::size_t>(chain.held)].offset),
      turns_(model.joints.is_periodic(chain.held)),
      rows_(kSamples) {
  chain_.use_limits(model);
  // Both ends of a range; but of a whole turn one is enough.
  const double range = model.joints.sample_upper(chain.held) - lower_;
  step_ = turns_ ? kTwoPi / kSamples : range / (kSamples - 1);
}

void Sweep::solve(lanes::BranchPack& pack, Row& off) const {
  kernels_.find_branches(chain_.form, pack);
  for (int lane = 0; lane < kBranches; ++lane) {
    off[static_cast<std::size_t>(lane)] =
        std::max(pack.beyond[lane], 0.0) + std::sqrt(std::max(-pack.least[lane], 0.0));
  }
}

bool Sweep::find(const Pose& Y) {
  chain_.set_target(Y, pack_);
  std::copy(std::begin(pack_.target), std::end(pack_.target), followed_.target);
  for (int k = 0; k < kSamples; ++k) {
    // Far from each other first, so that an answer is soon found; coprime to the number of samples.
    constexpr int kStride = 19;
    const int place = k * kStride % kSamples;
    const double q = lower_ + step_ * place;
    std::fill_n(pack_.held, kBranches, q + offset_);
    Row& off = rows_[static_cast<std::size_t>(place)];
    solve(pack_, off);
    const auto best = std::min_element(off.begin(), off.end());
    if (*best > 0) continue;
    take(pack_, q, static_cast<int>(best - off.begin()));
    return true;
  }
  find_nearest();
  least_ = near_count_ == 0 ? kInfinity : nearest_[0].off;
  for (std::size_t i = 0; i < near_count_; ++i) {
    if (follow(nearest_[i])) return true;
  }
  return false;
}

void Sweep::find_nearest() {
  near_count_ = 0;
  for (int place = 0; place < kSamples; ++place) {
    const Row& off = rows_[static_cast<std::size_t>(place)];
    const Row& before = row_at(place - 1);
    const Row& behind = row_at(place + 1);
    for (int lane = 0; lane < kBranches; ++lane) {
      const auto i = static_cast<std::size_t>(lane);
      if (off[i] > kNear || off[i] > before[i] || off[i] > behind[i]) continue;
      const Near near{off[i], place, lane};
      if (near_count_ == kFollowed && !(near < nearest_[kFollowed - 1])) continue;
      if (near_count_ < kFollowed) ++near_count_;
      std::size_t at = near_count_ - 1;
      for (; at > 0 && near < nearest_[at - 1]; --at) nearest_[at] = nearest_[at - 1];
      nearest_[at] = near;
    }
  }
}

const Sweep::Row& Sweep::row_at(int place) const {
  static constexpr Row kNone{kInfinity, kInfinity, kInfinity, kInfinity,
                             kInfinity, kInfinity, kInfinity, kInfinity};
  if (turns_) place = (place + kSamples) % kSamples;
  if (place < 0 || place == kSamples) return kNone;
  return rows_[static_cast<std::size_t>(place)];
}

bool Sweep::follow(const Near& near) {
  // Each round looks at so many places between the neighbours of the best so far.
  constexpr int kRounds = 4;
  for (int s = 0; s < 3; ++s) {
    std::fill_n(followed_.sign[s], kBranches, pack_.sign[s][near.lane]);
  }
  double middle = lower_ + step_ * near.place;
  double width = step_;
  bool found = false;
  for (int round = 0; round < kRounds && !found; ++round) {
    const double spacing = 2 * width / (kBranches + 1);
    const auto place = [&](std::ptrdiff_t lane) {
      const double q = middle - width + spacing * static_cast<double>(lane + 1);
      return turns_ ? q : std::min(std::max(q, lower_), lower_ + step_ * (kSamples - 1));
    };
    for (int lane = 0; lane < kBranches; ++lane) followed_.held[lane] = place(lane) + offset_;
    Row off;
    solve(followed_, off);
    const auto best = std::min_element(off.begin(), off.end());
    least_ = std::min(least_, *best);
    found = *best <= 0;
    if (found) take(followed_, place(best - off.begin()), static_cast<int>(best - off.begin()));
    middle = place(best - off.begin());
    width = spacing;
  }
  return found;
}

void Sweep::take(const lanes::BranchPack& pack, double swept, int lane) {
  q_[static_cast<std::size_t>(chain_.held)] = swept;
  chain_.copy_joints(pack, lane, q_.data());
}

}  // namespace iksel
