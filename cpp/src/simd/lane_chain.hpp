// SPDX-License-Identifier: BSD-3-Clause
// A chain as the lanes know it.
#pragma once

#include "kinematics/chain_model.hpp"
#include "simd/lane_types.hpp"

namespace iksel {

/// The `row`-th number of Y (reduction.hpp) as packs have it: its position, then its columns.
inline double full_pose_row(const Pose& Y, int row) { return Y(row % 3, (row / 3 + 3) % 4); }

/// True if the degrees of freedom are the joints, one to one: no mimic joints.
bool is_simple(const ChainModel& model);

/// The part between the frames of the first and the last joint.
lanes::LaneChain make_lane_chain(const ChainModel& model);
/// The same in single precision.
lanes::LaneChainOf<float> make_rough_chain(const ChainModel& model);

}  // namespace iksel
