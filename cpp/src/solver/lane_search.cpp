// SPDX-License-Identifier: BSD-3-Clause
#include "solver/lane_search.hpp"

#include <algorithm>

namespace iksel {

bool solves_in_lanes(const ChainModel& model, const DatabaseData& data,
                     const SolverOptions& options) {
  return options.iteration == Iteration::lm && options.kinematics == Kinematics::kernel &&
         data.reduction != nullptr && is_simple(model);
}

LaneSearch::LaneSearch(const ChainModel& model, const DatabaseData& data,
                       const SolverOptions& options, const lanes::LaneKernels& kernels)
    : model_(model),
      data_(data),
      options_(options),
      kernels_(kernels),
      solve_pack_(kernels.solve[model.dof <= 10 ? model.dof : 0]),
      chain_(make_lane_chain(model)),
      lane_options_{options.position_tolerance, options.rotation_tolerance, options.damping,
                    options.max_iterations},
      reduction_(data.reduction->for_lanes()),
      target_{},
      neighbours_(std::min<std::size_t>(static_cast<std::size_t>(options.neighbours), data.size)),
      group_(static_cast<std::size_t>(lanes::group_rows(model.dof) * lanes::kGroup)),
      // Room for a pack that starts at the last seed.
      seeds_(static_cast<std::size_t>((model.dof + 1) * lanes::kGroup)) {}

void LaneSearch::set_target(const Pose& tip_target) {
  const Pose Y = data_.reduction->reduce(tip_target);
  data_.reduction->make_key(Y, key_);
  target_ = make_lane_target(Y);
}

int LaneSearch::prepare(const double* group) {
  const unsigned valid = kernels_.prepare(chain_, target_, reduction_, group, seeds_.data());
  if (valid == (1U << static_cast<unsigned>(lanes::kGroup)) - 1) return lanes::kGroup;
  int count = 0;
  for (int s = 0; s < lanes::kGroup; ++s) {
    if ((valid >> static_cast<unsigned>(s) & 1U) == 0) continue;
    if (s != count) {
      for (int j = 0; j < model_.dof; ++j) {
        seeds_[static_cast<std::size_t>(j * lanes::kGroup + count)] =
            seeds_[static_cast<std::size_t>(j * lanes::kGroup + s)];
      }
    }
    ++count;
  }
  return count;
}

}  // namespace iksel
