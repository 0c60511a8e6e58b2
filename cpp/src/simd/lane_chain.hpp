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
lanes::LaneChain make_lane_chain(const ChainModel& model, double unit = 1);
/// The same in single precision.
lanes::LaneChainOf<float> make_rough_chain(const ChainModel& model, double unit = 1);

/// Joint values in metres and radians to and from those of a lane chain in a unit.
class JointUnits {
 public:
  JointUnits(const ChainModel& model, double unit) {
    for (int j = 0; j < model.dof; ++j) {
      unit_[j] = model.joints.is_slide(j) ? unit : 1;
      per_unit_[j] = 1 / unit_[j];
    }
  }
  template <typename Number>
  [[nodiscard]] Number to_lane(int joint, Number value) const {
    return value * static_cast<Number>(per_unit_[joint]);
  }
  template <typename Number>
  [[nodiscard]] Number from_lane(int joint, Number value) const {
    return value * static_cast<Number>(unit_[joint]);
  }

 private:
  double unit_[lanes::kMaxJoints];
  double per_unit_[lanes::kMaxJoints];
};

}  // namespace iksel
