// SPDX-License-Identifier: BSD-3-Clause
// A proof that a pose has no configuration inside the limits, of a chain that is known in closed
// form for each value of one joint: over the whole range of that joint, piece by piece, each branch
// is enclosed, for every target within the tolerances, and there is none, or it lies outside.
#pragma once

#include <array>
#include <vector>

#include "kinematics/chain_model.hpp"
#include "simd/kernels.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

class BranchEnclosure {
 public:
  /// `chain` has a joint that is held, and no loop; it is the model's own, as are the limits.
  /// Tolerances are the solver's [m, rad].
  BranchEnclosure(const ChainModel& model, const ClosedFormChain& chain, double position_tolerance,
                  double rotation_tolerance, const lanes::LaneKernels& kernels);

  /// Whether no configuration inside the limits is within the tolerances of Y (reduction.hpp).
  /// False says nothing.
  bool rules_out(const Pose& Y);
  /// Where that came to a piece so short that it says false: a configuration there. Null: nowhere.
  [[nodiscard]] const JointVector* doubt() const { return has_doubt_ ? &doubt_ : nullptr; }

 private:
  /// Values of the held joint, as the form counts it [rad or m]: middle +- half; and which of the
  /// third signs.
  struct Piece {
    double middle, half;
    std::array<bool, 2> with;
  };
  /// The same of branches of two signs.
  bool rules_out(const double (&sign)[2]);
  void keep_doubt(const double (&sign)[2], const Piece& piece);

  const JointSpace& joints_;
  ClosedFormChain chain_;
  const lanes::LaneKernels& kernels_;
  double offset_;         ///< what the form counts the held joint more
  double lower_, upper_;  ///< of the held joint, as the form counts it
  lanes::BranchPack target_{};
  std::vector<Piece> open_;
  int packs_left_ = 0;
  JointVector doubt_;
  bool has_doubt_ = false;
};

}  // namespace iksel
