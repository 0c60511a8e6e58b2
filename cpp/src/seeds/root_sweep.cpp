// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/root_sweep.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "structure/residual_form.hpp"

namespace iksel {
namespace {

/// So many times the tolerances, and what the axes lie off, away from axis 1, joint 1 is known well
/// enough: one reachable target of a million of gen3_6dof, whose pi is rounded, had been lost.
constexpr double kBesideAxis = 1000;

RootFinder make_finder(const ChainModel& model, int joint, double vague,
                       const lanes::LaneKernels& kernels) {
  constexpr double kBeyond = 0.05;
  const double offset = model.kernel.joints[static_cast<std::size_t>(joint)].offset;
  const double lower = model.joints.sample_lower(joint) - kBeyond;
  const double upper = model.joints.sample_upper(joint) + kBeyond;
  return {lower + offset, upper - lower, vague, kernels};
}

}  // namespace

RootSweep::RootSweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
                     double tolerance, const lanes::LaneKernels& kernels)
    : chain_(chain),
      kernels_(kernels),
      concludes_(concludes_from_branches(is_nominal, tolerance)),
      vague_(2 * std::sqrt(tolerance + chain.deviation)),
      vague_divisor_(std::pow(kBesideAxis * (tolerance + chain.deviation), 2)),
      roots_(make_finder(model, chain.held, vague_, kernels)) {
  chain_.use_limits(model);
  for (int lane = 0; lane < lanes::kWidth; ++lane) pack_.sign[2][lane] = 1;
}

void RootSweep::find(const Pose& Y, bool /*wants_all*/) {
  chain_.set_target(Y, pack_);
  roots_.find(make_residual(chain_, pack_));
  size_ = 0;
  certain_ = concludes_ && roots_.is_complete() && roots_.least_divisor() > vague_divisor_;
  constexpr std::size_t kAtOnce = lanes::kWidth / kBranches;
  for (std::size_t first = 0; first < roots_.size(); first += kAtOnce) {
    const std::size_t n = std::min(kAtOnce, roots_.size() - first) * kBranches;
    for (std::size_t lane = 0; lane < lanes::kWidth; ++lane) {
      pack_.held[lane] = roots_[first + std::min(lane, n - 1) / kBranches].angle;
    }
    kernels_.find_branches(chain_.form, pack_);
    for (std::size_t lane = 0; lane < n; ++lane) {
      take(roots_[first + lane / kBranches].is_vague, static_cast<int>(lane));
    }
  }
}

void RootSweep::take(bool is_vague, int lane) {
  // Roots are off by what the tolerances allow, many times over; but where there are two, by its
  // square root.
  const double slack = is_vague ? 4 * vague_ : 25 * vague_ * vague_;
  if (!(std::abs(pack_.residual[lane]) < slack && pack_.least[lane] > -slack &&
        pack_.beyond[lane] < slack)) {
    return;
  }
  // At a limit, what the tolerances allow decides.
  if (size_ == kMost || (!is_vague && pack_.beyond[lane] > 0)) certain_ = false;
  if (size_ == kMost) return;
  chain_.copy_joints(pack_, lane, q_[static_cast<std::size_t>(size_++)].data());
}

}  // namespace iksel
