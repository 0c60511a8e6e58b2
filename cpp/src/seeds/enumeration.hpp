// SPDX-License-Identifier: BSD-3-Clause
// All solutions of a pose in closed form, and when there are none the proof of it.
#pragma once

#include "kinematics/chain_model.hpp"
#include "seeds/branch_list.hpp"
#include "simd/kernels.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

/// The branches of one pose. They are not certain either where a branch is so close to a limit that
/// what the tolerances allow could make a difference.
class Enumeration final : public BranchList {
 public:
  /// `chain` is the nominal chain's; `is_nominal`: that of `model`, whose limits count. Tolerances
  /// are the solver's [m, rad].
  Enumeration(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
              double position_tolerance, double rotation_tolerance,
              const lanes::LaneKernels& kernels);

  /// From now on, joints of which the angle does not matter stay as in q, inside the limits, so
  /// that each branch is but the one solution that is nearest to it; null: they are anywhere. q
  /// must outlive what is found so.
  void hold_free_joints(const JointVector* q);
  /// Of the task that the chain was completed for. Where not all are wanted, branches inside the
  /// limits are not looked at any closer: one of them will do.
  void find(const Pose& Y, bool wants_all) override;
  /// Solves for all branches, inside the limits or not, for chain() and pack().
  void solve(const Pose& Y);

  /// What the last solve() found: those outside the limits too, and lanes without a branch.
  [[nodiscard]] const ClosedFormChain& chain() const { return chain_; }
  [[nodiscard]] const lanes::BranchPack& pack() const { return pack_; }
  /// Writes a lane's joint values to q, those of which the angle does not matter inside their
  /// limits.
  void copy_joints(int lane, double* q) const;

 private:
  /// Takes a lane's branch if it may be one.
  void take(const Pose& Y, int lane, bool wants_all);
  /// Takes where it may be at the other limit of joints whose limits all but meet round the turn: a
  /// form that is but nearly the arm's may have it on the wrong side of them.
  void take_turned(const Pose& Y, int lane);
  /// Whether the arm's solution beside q is certainly no answer (beyond_limits.hpp).
  [[nodiscard]] bool is_beyond(const Pose& Y, const Joints& q) const;
  /// Whether it is certain that a lane's branch is outside of limits, or none, however little its
  /// angles are determined (enclosure_kernel.hpp).
  bool is_enclosed_outside(int lane);
  /// Whether a lane's branch reaches the target far enough from singularities to tell by how much
  /// the tolerances may move it [rad].
  bool is_regular(int lane, double& bound);

  const ChainModel& model_;
  ClosedFormChain chain_;
  const lanes::LaneKernels& kernels_;
  bool is_nominal_;
  double position_tolerance_, rotation_tolerance_;  ///< [m, rad]
  double enclosed_error_;                           ///< what the target may be off by, at most
  lanes::BranchPack pack_ = all_branches();
  lanes::Regularity regularity_{};
  bool is_measured_ = false;  ///< these, of the last find()
  double room_[2][lanes::kWidth];
  bool is_enclosed_ = false;  ///< the same of these
  const JointVector* held_ = nullptr;
};

/// Whether a lane that solve_branches solved has no branch inside the limits, or none at all, as
/// far as the form's error lets it be told.
bool is_ruled_out(const lanes::BranchPack& pack, int lane);

}  // namespace iksel
