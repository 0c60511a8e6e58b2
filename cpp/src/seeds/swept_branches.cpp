// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/swept_branches.hpp"

#include <iterator>

namespace iksel {

SweptBranches::SweptBranches(const ChainModel& model, const ClosedFormChain& chain,
                             const lanes::LaneKernels& kernels)
    : chain_(chain),
      kernels_(kernels),
      lower_(model.joints.sample_lower(chain.held)),
      upper_(model.joints.sample_upper(chain.held)),
      offset_(model.kernel.joints[static_cast<std::size_t>(chain.held)].offset),
      turns_(model.joints.is_periodic(chain.held)) {
  chain_.use_limits(model);
}

Places SweptBranches::places(int count) const {
  if (!turns_) return {lower_, (upper_ - lower_) / (count - 1), count, false};
  // Not at the limits, of which one image lies beyond.
  const double step = kTwoPi / count;
  return {lower_ + 0.5 * step, step, count, true};
}

void SweptBranches::set_target(const Pose& Y) {
  chain_.set_target(Y, all_);
  std::copy(std::begin(all_.target), std::end(all_.target), one_.target);
}

void SweptBranches::solve_all(double value) {
  std::fill_n(all_.held, kCount, value + offset_);
  kernels_.find_branches(chain_.form, all_);
  last_ = &all_;
}

void SweptBranches::solve_one(int branch, const Row& values) {
  for (int s = 0; s < 3; ++s) std::fill_n(one_.sign[s], kCount, all_.sign[s][branch]);
  for (int lane = 0; lane < kCount; ++lane) {
    one_.held[lane] = values[static_cast<std::size_t>(lane)] + offset_;
  }
  kernels_.find_branches(chain_.form, one_);
  last_ = &one_;
}

double SweptBranches::find_fold(int branch, double inside, double outside, int rounds) {
  double least_inside = 0;
  double least_outside = -1;
  for (int round = 0; round < rounds; ++round) {
    const double step = (outside - inside) / (kCount + 1);
    const double from = inside;
    Row values;
    for (int lane = 0; lane < kCount; ++lane) {
      values[static_cast<std::size_t>(lane)] = from + step * (lane + 1);
    }
    solve_one(branch, values);
    for (int lane = 0; lane < kCount; ++lane) {
      if (least(lane) < 0) {
        outside = values[static_cast<std::size_t>(lane)];
        least_outside = least(lane);
        break;
      }
      inside = values[static_cast<std::size_t>(lane)];
      least_inside = least(lane);
    }
  }
  return inside + (outside - inside) * least_inside / (least_inside - least_outside);
}

}  // namespace iksel
