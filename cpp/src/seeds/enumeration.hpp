// SPDX-License-Identifier: BSD-3-Clause
// All solutions of a pose in closed form: seeds that are there already, and when there are none the
// proof of it.
#pragma once

#include <array>

#include "base/work.hpp"
#include "goal/goal.hpp"
#include "simd/kernels.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

/// The branches of one pose.
class Enumeration {
 public:
  static constexpr int kMost = lanes::kWidth;

  /// `chain` is the nominal chain's; `is_nominal`: that of `model`, whose limits count. Tolerances
  /// are the solver's [m, rad].
  Enumeration(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
              double position_tolerance, double rotation_tolerance,
              const lanes::LaneKernels& kernels);

  /// Finds the branches of a target that lie inside the limits, or so near to them that it cannot
  /// be told; of the task that the chain was completed for. Y as in reduction.hpp. Where not all
  /// are wanted, branches inside the limits are not looked at any closer: one of them will do.
  void find(const Pose& Y, bool wants_all);
  /// Solves for all branches, inside the limits or not, for chain() and pack().
  void solve(const Pose& Y);
  [[nodiscard]] int size() const { return size_; }
  /// Inside the limits [rad].
  [[nodiscard]] const double* q(int i) const { return q_[static_cast<std::size_t>(i)].data(); }
  /// Whether they reach the goal without being refined, as a rule.
  [[nodiscard]] bool are_answers() const { return are_answers_; }
  /// Whether these are the solutions, no more and no less. Not where the arm is so close to a
  /// singularity, or a branch so close to a limit, that what the tolerances allow could make a
  /// difference.
  [[nodiscard]] bool is_certain() const { return certain_; }
  /// Whether these are the solutions but for branches so close to a limit, and away from
  /// singularities: such a branch is one, or there is none beside it.
  [[nodiscard]] bool is_certain_but_for_limits() const { return certain_but_for_limits_; }
  /// Whether the arm may be singular at one of these.
  [[nodiscard]] bool may_be_singular() const { return may_be_singular_; }
  /// Whether each solution is near to one of these, if they are not certain either.
  [[nodiscard]] bool has_all() const { return is_nominal_ && !has_families(); }
  /// Whether each branch stands for many solutions.
  [[nodiscard]] bool has_families() const { return chain_.has_families(); }

  /// What the last solve() found: those outside the limits too, and lanes without a branch.
  [[nodiscard]] const ClosedFormChain& chain() const { return chain_; }
  [[nodiscard]] const lanes::BranchPack& pack() const { return pack_; }
  /// Writes a lane's joint values to q, those of which the angle does not matter inside their
  /// limits.
  void copy_joints(int lane, double* q) const;

 private:
  /// Takes a lane's branch if it may be one.
  void take(const Pose& Y, int lane, bool wants_all);
  /// Whether q is one of those taken so far.
  [[nodiscard]] bool has_taken(const std::array<double, 6>& q) const;
  /// Whether a lane's branch reaches the target far enough from singularities to tell by how much
  /// the tolerances may move it [rad].
  bool is_regular(int lane, double& bound);

  const ChainModel& model_;
  ClosedFormChain chain_;
  const lanes::LaneKernels& kernels_;
  bool is_nominal_;
  bool are_answers_;
  double position_tolerance_, rotation_tolerance_;  ///< [m, rad]
  lanes::BranchPack pack_ = all_branches();
  std::array<std::array<double, 6>, kMost> q_{};
  lanes::Regularity regularity_{};
  bool is_measured_ = false;  ///< these, of the last find()
  int size_ = 0;
  bool certain_ = false;
  bool certain_but_for_limits_ = false;
  bool may_be_singular_ = false;
};

/// Whether a lane that solve_branches solved has no branch inside the limits, or none at all, as
/// far as the form's error lets it be told.
bool is_ruled_out(const lanes::BranchPack& pack, int lane);

/// These as a source of seeds, or those of a RootSweep.
template <typename Branches>
class EnumeratedSeeds {
 public:
  EnumeratedSeeds(Branches& branches, const Pose& Y, bool wants_all, Work& work, StageClock& clock)
      : branches_(branches), Y_(Y), wants_all_(wants_all), work_(work), clock_(clock) {}

  bool next_stage() {
    if (done_ || !work_.has_left()) return false;
    done_ = true;
    branches_.find(Y_, wants_all_);
    clock_.lap(&StageTimes::query);
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (next_ == branches_.size() || !work_.take()) return false;
    const double* q = branches_.q(next_++);
    if (branches_.are_answers()) {
      refiner.load_answer(lane, q);
    } else {
      refiner.load_seed(lane, q);
    }
    return true;
  }

  /// Whether there are certainly no solutions but these, and each was tried.
  [[nodiscard]] bool is_certain() const { return branches_.is_certain() && was_tried(); }
  /// As of the branches, and each was tried.
  [[nodiscard]] bool is_certain_but_for_limits() const {
    return branches_.is_certain_but_for_limits() && was_tried();
  }
  /// Whether each solution is near to one of these, and each was tried.
  [[nodiscard]] bool has_all() const { return branches_.has_all() && was_tried(); }
  /// Whether there are none.
  [[nodiscard]] bool is_empty() const { return branches_.size() == 0; }

 private:
  [[nodiscard]] bool was_tried() const { return done_ && next_ == branches_.size(); }

  Branches& branches_;
  const Pose& Y_;
  bool wants_all_;
  Work& work_;
  StageClock& clock_;
  bool done_ = false;
  int next_ = 0;
};

}  // namespace iksel
