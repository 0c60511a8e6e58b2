// SPDX-License-Identifier: BSD-3-Clause
// A chain as the lanes know it.
#pragma once

#include "kinematics/chain_model.hpp"
#include "simd/lane_types.hpp"

namespace iksel {

/// Calls write(row, number) of the rows by which packs have Y (reduction.hpp): its position, in a
/// unit of which a metre has so many, then its columns.
template <typename Write>
void visit_rows(const Pose& Y, double per_metre, const Write& write) {
  for (int i = 0; i < 3; ++i) {
    write(i, Y(i, 3) * per_metre);
    for (int k = 0; k < 3; ++k) write(3 + 3 * k + i, Y(i, k));
  }
}

/// True if the degrees of freedom are the joints, one to one: no mimic joints.
bool is_simple(const ChainModel& model);

/// The part between the frames of the first and the last joint, with lengths in that unit.
template <typename Number = double>
lanes::LaneChainOf<Number> make_lane_chain(const ChainModel& model, double unit = 1);

}  // namespace iksel
