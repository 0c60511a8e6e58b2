// SPDX-License-Identifier: BSD-3-Clause
// Closed forms of many poses at once: a pose in each lane, of which one branch is tried after the
// other. Most poses are solved by the first few, which cost an eighth of a pack each.
#pragma once

#include "goal/goal.hpp"
#include "kinematics/chain_model.hpp"
#include "seeds/branch_trials.hpp"
#include "simd/kernels.hpp"

namespace iksel {

/// Both the seeds of a BatchStream and their refiner (search.hpp): a branch is there at once, or
/// never.
class BranchLanes {
 public:
  /// `chain` has the error of its form, if all branches are tried.
  BranchLanes(const ChainModel& model, const ClosedFormChain& chain, const BranchTrials& trials,
              const lanes::LaneKernels& kernels);

  // As the refiner.
  [[nodiscard]] static int width() { return lanes::kWidth; }
  int advance(unsigned busy);
  [[nodiscard]] bool has_arrived(int lane) const { return lanes_[lane].is_inside; }
  [[nodiscard]] static bool is_spent(int /*lane*/) { return true; }
  static bool stays(int /*lane*/) { return false; }
  [[nodiscard]] static bool is_to_be_looked_at(int /*lane*/) { return false; }
  [[nodiscard]] static int age(int /*lane*/) { return 0; }
  [[nodiscard]] JointVector at(int lane) const { return q(lane); }
  [[nodiscard]] JointVector q(int lane) const;

  // As the seeds; LeafLanes has what each is for.
  void begin(BranchLanes& /*refiner*/, int lane, const Goal& goal, const Pose& Y);
  bool load(BranchLanes& refiner, int lane);
  [[nodiscard]] int attempts(int lane) const { return lanes_[lane].refused + 1; }
  void refuse(int lane) { ++lanes_[lane].refused; }
  /// Of six joints nothing where a branch is near to a singularity or a limit.
  [[nodiscard]] Proof proof(int lane) const;

 private:
  struct Lane {
    BranchTrials::Range trials{};
    double turn = 0;  ///< of the pose [rad]
    bool is_inside = false;
    bool is_unsure = false;  ///< of one of the branches it cannot be told whether it is an answer
    int refused = 0;
  };
  /// All branches are tried: what is unsure is left to those who look closer (Enumeration).
  [[nodiscard]] bool is_complete() const { return form_.chain.held < 0; }

  const JointSpace& joints_;
  TrialForm form_;
  const BranchTrials& trials_;
  lanes::BranchPack pack_;
  Lane lanes_[lanes::kWidth];
};

}  // namespace iksel
