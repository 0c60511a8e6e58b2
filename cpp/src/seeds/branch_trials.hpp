// SPDX-License-Identifier: BSD-3-Clause
// Which branches of a closed form are tried of a pose before anything is searched for. Of seven
// joints one is held, and there are too many angles to hold it at: those are tried that solve other
// poses near by.
//
// With Y as in reduction.hpp, the first joint turns the position c of Y about its axis, and the
// last joint turns c as Y sees it: values of a held joint are kept relative to that angle, so that
// poses which differ by the outer joints alone have the same trials. Where it slides, the same with
// ways along its axis.
#pragma once

#include <cstddef>
#include <vector>

#include "database/data.hpp"
#include "goal/goal.hpp"
#include "kinematics/chain_model.hpp"
#include "simd/kernels.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

/// A branch to try.
struct BranchTrial {
  int branch;   ///< the lane of all_branches() that has its signs
  double held;  ///< value of the joint that is held less the pose's turn [rad or m]
};

/// A closed form with a pack for trials, in which each lane has its own.
struct TrialForm {
  /// `chain` has the error of its form, if that matters.
  TrialForm(const ChainModel& model, const ClosedFormChain& chain,
            const lanes::LaneKernels& kernels);

  /// Sets a lane to a trial for a pose with that turn.
  void set_trial(const BranchTrial& trial, double turn, int lane, lanes::BranchPack& pack) const;
  /// Whether a lane that was solved has a branch inside the limits.
  [[nodiscard]] bool is_inside(const lanes::BranchPack& pack, int lane) const;
  /// Value of the held joint [rad or m].
  [[nodiscard]] double held(const lanes::BranchPack& pack, int lane) const {
    return pack.held[lane] - offset_;
  }

  ClosedFormChain chain;
  const lanes::LaneKernels& kernels;

 private:
  double lower_ = 0, upper_ = 0, offset_ = 0;  ///< of the held joint [rad or m]
  bool slides_ = false;
};

class BranchTrials {
 public:
  /// Of six joints all branches, of seven those chosen by random configurations: none where the
  /// form is not exact enough for `task`, a full pose. `chain` is the model's, or nearly, and
  /// `data`, which has to outlive this, has a reduced key.
  BranchTrials(const ChainModel& model, const ClosedFormChain& chain, const DatabaseData& data,
               const TaskSpace& task, const lanes::LaneKernels& kernels);

  /// What is tried of a pose, best first.
  struct Range {
    const BranchTrial* next;
    const BranchTrial* end;
  };
  [[nodiscard]] Range of(const Pose& Y) const;
  /// By how much the pose's outer joint is turned, or slid [rad or m]; of six joints 0.
  [[nodiscard]] double turn(const Pose& Y) const;

 private:
  /// A random configuration with its pose.
  struct Example;

  [[nodiscard]] std::size_t cell(const Pose& Y) const;
  std::vector<Example> make_examples(const ChainModel& model, const ClosedFormChain& chain,
                                     const TaskSpace& task,
                                     const lanes::LaneKernels& kernels) const;
  /// Adds the trials of a cell with those examples.
  void add_cell(const TrialForm& form, const Example* examples, std::size_t count);

  const DatabaseData& data_;
  int held_;
  bool slides_;
  /// Levels of the database's tree that tell cells apart.
  int levels_ = 0;
  std::vector<BranchTrial> trials_;
  std::vector<std::size_t> first_;  ///< of each cell, and the end
};

}  // namespace iksel
