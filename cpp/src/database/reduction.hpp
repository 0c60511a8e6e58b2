// SPDX-License-Identifier: BSD-3-Clause
// The symmetry that makes a database small: FK commutes with the first joint, and the last joint
// only moves the tip link about or along its own axis.
//
// With B and F constant, T_base_tip = B * first(q_1) * M(q_2 .. q_n-1) * last(q_n) * F. For a
// target X let Y = B^-1 X F^-1, with position c and columns x, y, z. A first joint that turns,
// turns c and z about the first axis together; a last joint that turns changes neither. So the
// cylinder coordinates of c and z, z written relative to the azimuth of c, are the same for every
// q_1 and q_n, and the samples need only cover the joints between. Slides are left out likewise:
// the first by the coordinate along it, the last by the foot of the perpendicular onto its line.
#pragma once

#include "kinematics/chain_model.hpp"
#include "simd/lane_chain.hpp"

namespace iksel {

struct Reduction {
  lanes::Side left = lanes::Side::none;
  lanes::Side right = lanes::Side::none;
  int dof = 0;
  double weight = 0;  ///< length that a unit of the axes counts in the key [m]
  StoredPose base_inverse = StoredPose::Identity();
  StoredPose flange_inverse = StoredPose::Identity();

  /// Leaves out both sides of the chain as far as that can be.
  static Reduction of(const ChainModel& model, double weight);

  [[nodiscard]] int key_dimension() const;
  /// True if the joint is left out of the samples, which have it where its motion is zero.
  [[nodiscard]] bool leaves_out(int joint) const;

  /// Y = B^-1 T F^-1 for the pose of the tip link.
  [[nodiscard]] Pose reduce(const Pose& T_base_tip) const;
  void make_key(const Pose& Y, double* key) const;
  /// Y with the motions of the left-out joints at q taken off, as the samples have it.
  [[nodiscard]] Pose without_outer_joints(const Pose& Y, const lanes::LaneChain& chain,
                                          const double* q) const;
};

/// The joints of a simple chain as seeds are prepared for them.
lanes::SeedChain make_seed_chain(const ChainModel& model, const Reduction& reduction);

/// Y as seeds are prepared for it.
lanes::SeedTarget make_seed_target(const Pose& Y);

}  // namespace iksel
