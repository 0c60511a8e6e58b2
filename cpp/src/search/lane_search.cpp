// SPDX-License-Identifier: BSD-3-Clause
#include "search/lane_search.hpp"

#include <algorithm>

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

bool solves_in_lanes(const ChainModel& model, const DatabaseData& data,
                     const SolverOptions& options) {
  return options.iteration == Iteration::lm && options.kinematics == Kinematics::kernel &&
         data.reduction != nullptr && is_simple(model);
}

LaneSearch::LaneSearch(const ChainModel& model, const ChainModel& nominal, const DatabaseData& data,
                       const SolverOptions& options, const lanes::LaneKernels& kernels)
    : model_(model),
      data_(data),
      options_(options),
      kernels_(kernels),
      base_inverse_(to_pose(model.kernel.base).inverse()),
      tcp_inverse_(Pose(model.tcp_inverse) * to_pose(model.kernel.flange).inverse()),
      advance_(kernels.advance),
      chain_(make_lane_chain(model)),
      lane_options_(make_lane_options(model, options)),
      seed_chain_(make_seed_chain(nominal, *data.reduction)),
      seeds_{},
      pack_{},
      neighbours_(std::min<std::size_t>(static_cast<std::size_t>(options.neighbours), data.size)),
      block_(static_cast<std::size_t>(lanes::block_rows(model.dof) * lanes::kBlock)),
      block_distance2_(data.blocks.size()),
      block_order_(data.blocks.size()),
      block_seeds_(kBlocksAtOnce),
      queue_(model, kernels) {}

Pose LaneSearch::set_query(const Pose& T_base_tcp) {
  Pose Y = base_inverse_ * T_base_tcp * tcp_inverse_;
  data_.reduction->make_key(Y, key_);
  seed_target_ = make_seed_target(Y);
  return Y;
}

void LaneSearch::set_target(const Pose& T_base_tcp) {
  const Pose Y = set_query(T_base_tcp);
  for (int lane = 0; lane < kernels_.lanes; ++lane) set_lane_target(lane, Y);
}

void LaneSearch::set_lane_target(int lane, const Pose& Y) {
  for (int i = 0; i < 3; ++i) {
    pack_.target[i][lane] = Y(i, 3);
    for (int column = 0; column < 3; ++column) {
      pack_.target[3 + 3 * column + i][lane] = Y(i, column);
    }
  }
}

void LaneSearch::load_ranked(int rank, int lane) { load_slot(seeds_, seeds_.order[rank], lane); }

void LaneSearch::load_slot(const lanes::SeedPack& seeds, int entry, int lane) {
  for (int j = 0; j < model_.dof; ++j) {
    pack_.q[j][lane] = static_cast<double>(seeds.q[j][entry]);
  }
}

void LaneSearch::load_seed(int lane, const double* q) {
  for (int j = 0; j < model_.dof; ++j) {
    const lanes::LaneJoint& joint = chain_.joint[j];
    pack_.q[j][lane] = joint.limited ? std::min(std::max(q[j], joint.lower), joint.upper) : q[j];
  }
}

}  // namespace iksel
