// SPDX-License-Identifier: BSD-3-Clause
// A chain as the lanes know it.
#pragma once

#include "kinematics/chain_model.hpp"
#include "simd/lane_types.hpp"

namespace iksel {

/// The `row`-th number of Y (reduction.hpp) as packs have it: its position, in a unit of which a
/// metre has so many, then its columns.
inline double full_pose_row(const Pose& Y, int row, double per_metre = 1) {
  const double number = Y(row % 3, (row / 3 + 3) % 4);
  return row < 3 ? number * per_metre : number;
}

/// True if the degrees of freedom are the joints, one to one: no mimic joints.
bool is_simple(const ChainModel& model);

/// The part between the frames of the first and the last joint, with lengths in that unit.
template <typename Number = double>
lanes::LaneChainOf<Number> make_lane_chain(const ChainModel& model, double unit = 1);

}  // namespace iksel
