// SPDX-License-Identifier: BSD-3-Clause
// Six joints of which one is swept over its range: for each of its values the others are known in
// closed form but for a residual, whose roots are the solutions.
#pragma once

#include <array>

#include "goal/goal.hpp"
#include "kinematics/chain_model.hpp"
#include "seeds/root_finder.hpp"
#include "simd/branch_types.hpp"
#include "structure/closed_form.hpp"
#include "structure/loop_polynomial.hpp"

namespace iksel {

class RootSweep {
 public:
  static constexpr int kMost = 96;

  /// `chain` is the nominal chain's, with a residual; its limits are the model's. `is_nominal`: it
  /// is the model's own. `tolerance` is the larger of the solver's [rad, and m in units of the
  /// reach].
  RootSweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
            double tolerance, const lanes::LaneKernels& kernels);

  /// Finds the solutions of the goal, a full pose, that lie inside the limits, or so near to them
  /// that it cannot be told. Y as in reduction.hpp. Where all are wanted, it is looked whether they
  /// come in families.
  void find(const Pose& Y, bool wants_all);
  [[nodiscard]] int size() const { return size_; }
  /// Inside the limits, or nearly [rad].
  [[nodiscard]] const double* q(int i) const { return q_[static_cast<std::size_t>(i)].data(); }
  /// Whether they reach the goal without being refined, as a rule.
  [[nodiscard]] bool are_answers() const { return are_answers_; }
  /// Whether there are no solutions but near to these.
  [[nodiscard]] bool is_certain() const { return certain_; }
  /// The same but for those so close to a limit, and away from singularities: such a one is a
  /// solution, or there is none beside it.
  [[nodiscard]] bool is_certain_but_for_limits() const { return certain_but_for_limits_; }
  /// Whether the arm may be singular at one of these, where roots are double.
  [[nodiscard]] bool may_be_singular() const { return may_be_singular_; }
  /// Double roots may be missed.
  [[nodiscard]] static bool has_all() { return false; }
  [[nodiscard]] static bool has_families() { return false; }

 private:
  /// Finds the roots by the product over all branches, or by the loop's determinant. Returns
  /// whether rounding leaves enough of it to conclude from.
  bool find_product_roots(const Pose& Y);
  bool find_loop_roots(const Pose& Y);
  void take(const Pose& Y, const RootFinder::Root& root, int lane);
  /// Whether one of these is singular, or almost.
  [[nodiscard]] bool has_singular() const;

  const ChainModel& model_;
  ClosedFormChain chain_;
  const lanes::LaneKernels& kernels_;
  double tolerance_;
  bool are_answers_, concludes_;
  double vague_;          ///< by how much roots that are nearly double may be off [rad]
  double farther_;        ///< vague roots that are farther apart must be nearer to an answer [rad]
  double vague_divisor_;  ///< nothing is concluded from residuals divided by less [units^2]
  RootFinder roots_;
  LoopPolynomial polynomial_;
  lanes::LoopTarget loop_{};
  lanes::BranchPack pack_ = all_branches();
  std::array<std::array<double, 6>, kMost> q_{};
  int size_ = 0;
  bool certain_ = false;
  bool is_at_limit_ = false;
  bool is_delicate_ = false;  ///< whether one may be singular
  bool certain_but_for_limits_ = false;
  bool may_be_singular_ = false;
};

}  // namespace iksel
