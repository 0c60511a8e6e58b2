// SPDX-License-Identifier: BSD-3-Clause
#include "refine/lane_refiner.hpp"

#include "simd/lane_chain.hpp"

namespace iksel {
namespace {

lanes::LaneOptions make_lane_options(const ChainModel& model, const SolverOptions& options) {
  lanes::LaneOptions lanes{};
  const double position = options.position_tolerance;
  const double rotation = options.rotation_tolerance;
  const Frame<double>& tip = model.kernel.tip;
  lanes.damping = options.damping;
  // |error at the TCP| <= |position error| + lever * |rotation error|, and the square of a sum of
  // two is at most twice the sum of their squares.
  lanes.lever2 = tip.p[0] * tip.p[0] + tip.p[1] * tip.p[1] + tip.p[2] * tip.p[2];
  lanes.position2 = 0.5 * position * position;
  lanes.rotation2 = 0.998 * rotation * rotation;
  // The error after a Newton step is about half the second derivative of FK times the squared step;
  // that derivative is at most the reach for positions and 1 for rotations, and mostly less.
  lanes.last_step2 = std::min(position / std::max(model.reach, 1e-3), rotation);
  lanes.last_error2 = 16 * lanes.last_step2;
  return lanes;
}

}  // namespace

LaneRefiner::LaneRefiner(const ChainModel& model, const SolverOptions& options,
                         const lanes::LaneKernels& kernels)
    : kernels_(kernels),
      max_iterations_(options.max_iterations),
      chain_(make_lane_chain(model)),
      options_(make_lane_options(model, options)),
      pack_{} {}

void LaneRefiner::begin(const Patience& patience) {
  patience_ = patience;
  patience_.far_off = std::min(patience.far_off, max_iterations_);
  patience_.most = std::min(patience.most, max_iterations_);
}

void LaneRefiner::set_target(const Pose& Y) {
  // Columns after the position, as LanePack has them.
  for (int row = 0; row < 12; ++row) {
    std::fill_n(pack_.target[row], lanes::kWidth, Y(row % 3, (row / 3 + 3) % 4));
  }
}

void LaneRefiner::set_target(int lane, const Pose& Y) {
  for (int row = 0; row < 12; ++row) pack_.target[row][lane] = Y(row % 3, (row / 3 + 3) % 4);
}

void LaneRefiner::load_seed(int lane, const double* q) {
  load(lane, [&](int j) {
    const lanes::LaneJoint& joint = chain_.joint[j];
    return joint.limited ? std::min(std::max(q[j], joint.lower), joint.upper) : q[j];
  });
}

int LaneRefiner::advance(unsigned busy) {
  int budget = patience_.look > 0 ? std::min(patience_.look, patience_.most) : patience_.most;
  for (int lane = 0; lane < width(); ++lane) {
    if ((busy >> static_cast<unsigned>(lane) & 1U) == 0) continue;
    const bool hasty = patience_.look == 0 && age_[lane] < patience_.far_off;
    budget = std::min(budget, (hasty ? patience_.far_off : patience_.most) - age_[lane]);
  }
  const lanes::PackResult result = kernels_.advance(chain_, options_, busy, budget, pack_);
  arrived_ = result.done;
  for (int lane = 0; lane < width(); ++lane) age_[lane] += result.iterations;
  return result.iterations;
}

}  // namespace iksel
