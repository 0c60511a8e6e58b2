// SPDX-License-Identifier: BSD-3-Clause
// Six joints of which one is swept over its range: for each of its values the others are known in
// closed form but for a residual, whose roots are the solutions.
#pragma once

#include "kinematics/chain_model.hpp"
#include "seeds/branch_list.hpp"
#include "seeds/root_finder.hpp"
#include "simd/branch_types.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

/// Double roots may be missed.
class RootSweep final : public BranchList {
 public:
  /// `chain` is the nominal chain's, with a residual; its limits are the model's. `is_nominal`: it
  /// is the model's own. `tolerance` is the larger of the solver's [rad, and m in units of the
  /// reach].
  RootSweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
            double tolerance, const lanes::LaneKernels& kernels);

  /// Where all are wanted, it is looked whether they come in families.
  void find(const Pose& Y, bool wants_all) override;

 private:
  /// Finds the roots by the product over all branches, or by the loop's determinant. Returns
  /// whether rounding leaves enough of it to conclude from.
  bool find_product_roots(const Pose& Y);
  bool find_loop_roots(const Pose& Y);
  /// What is at the roots; of a loop, at those that are vague, where two solutions are or none, or
  /// at the others.
  void take_all(const Pose& Y, bool are_pairs);
  void take(const Pose& Y, const RootFinder::Root& root, int lane);
  /// Beside a root of the product where the residual of a lane's branch is 0: where the branch only
  /// just is, both grow as the root of what that angle is off. The lane of crossing_ that is
  /// nearest to it, or -1.
  int find_crossing(double angle, int lane);
  /// Whether one of these is singular, or almost.
  [[nodiscard]] bool has_singular() const;

  const ChainModel& model_;
  ClosedFormChain chain_;
  const lanes::LaneKernels& kernels_;
  double tolerance_;
  bool concludes_;
  double vague_;          ///< by how much roots that are nearly double may be off [rad]
  double farther_;        ///< vague roots that are farther apart must be nearer to an answer [rad]
  double vague_divisor_;  ///< nothing is concluded from residuals divided by less [units^2]
  double at_end_;  ///< a branch that only is by less may be one that has the root [mixed units]
  RootFinder roots_;
  LoopPolynomial polynomial_;
  lanes::LoopTarget loop_{};
  lanes::BranchPack pack_ = all_branches();
  lanes::BranchPack crossing_{};
  bool is_at_limit_ = false;
  bool is_delicate_ = false;  ///< whether one may be singular
};

}  // namespace iksel
