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

  // The same step by step: what is open are pieces of the held joint's range, all equally long,
  // those of an arm one behind the other.

  /// Values of the held joint, as the form counts it, from middle - half() to middle + half()
  /// [rad or m]: of branches of two signs, by their number, and which of the third.
  struct Piece {
    double middle;
    int arm;
    std::array<bool, 2> with;
  };
  /// Opens the whole range of each branch.
  void begin(const Pose& Y);
  /// Closes the pieces in which nothing is inside the limits.
  void close();
  /// Whether there is nothing open, or it would not help to halve it once more.
  [[nodiscard]] bool is_through() const;
  void halve();
  [[nodiscard]] const std::vector<Piece>& open() const { return open_; }
  [[nodiscard]] double half() const { return half_; }

 private:
  ClosedFormChain chain_;
  const lanes::LaneKernels& kernels_;
  double lower_, upper_;  ///< of the held joint, as the form counts it
  lanes::BranchPack pack_{};
  std::vector<Piece> open_, halves_;
  double half_ = 0;
  bool helps_ = true;  ///< whether it helped to halve them
};

}  // namespace iksel
