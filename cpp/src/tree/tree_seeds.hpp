// SPDX-License-Identifier: BSD-3-Clause
// Sources of seeds for several tips at once, made of what the solvers of the chains know.
#pragma once

#include <utility>
#include <vector>

#include "base/constants.hpp"
#include "base/work.hpp"
#include "goal/joint_move.hpp"
#include "tree/arm_search.hpp"

namespace iksel {

/// The configuration to stay near, and the least move from it so far: what is farther away is of no
/// use.
struct NearBound {
  const JointVector& near;
  const JointMove& move;
  double best = kInfinity;
};

/// Values of the shared joints: those of `near` if there is one, those in the middle of the limits,
/// then spread evenly over the limits, as far as they lie within the bound.
class SharedValues {
 public:
  /// `bound` may be null. All must outlive this.
  SharedValues(const TreeModel& model, const NearBound* bound);

  /// Writes the next ones to q.
  void next(JointVector& q);

 private:
  /// Moves the shared joints inside the coupled limits that are of these alone.
  void hold_coupled(JointVector& q) const;
  /// What of a joint's range is of use.
  [[nodiscard]] std::pair<double, double> range(int joint) const;

  const TreeModel& model_;
  const NearBound* bound_;
  int index_;
  std::vector<double> step_;
};

/// The arms solved behind one value of the shared joints after another; a stage has one value. Only
/// where all arms could be solved is there a seed, which is an answer already.
class ArmSeeds {
 public:
  /// `bound` may be null. All must outlive this.
  ArmSeeds(const StackedGoal& goal, ArmSearch& arms, const NearBound* bound, Work& work);

  bool next_stage();
  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (!is_complete_) return false;
    is_complete_ = false;
    refiner.load_seed(lane, q_.data());
    return true;
  }

 private:
  /// Whether the shared joints, and those of the solved arms, alone move too far.
  [[nodiscard]] bool is_too_far(unsigned solved) const;

  const StackedGoal& goal_;
  ArmSearch& arms_;
  const NearBound* bound_;
  Work& work_;
  SharedValues values_;
  /// Values left, and those left until one has to be nearer than the best so far.
  int left_, patience_;
  double last_best_ = kInfinity;
  /// The arm that could not be solved last time is tried first.
  int first_ = 0;
  JointVector q_;
  bool is_complete_ = false;
};

/// Seeds for all joints together. One chain after another is solved as a whole, which sets the
/// shared joints; the arms of the others are brought as close as they come behind it, or where
/// there are none they are at random. (What ArmSeeds could solve in part is no better to begin
/// from: of 84,000 reachable targets of seven pairs of arms none is lost either way.)
class StackedSeeds {
 public:
  /// All must outlive this.
  StackedSeeds(const StackedGoal& goal, ArmSearch& arms, std::uint64_t seed, Work& work,
               TreeResult& result)
      : goal_(goal), arms_(arms), random_(seed), work_(work), result_(result) {}

  bool next_stage();
  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (!is_loaded_) return false;
    is_loaded_ = false;
    refiner.load_seed(lane, q_.data());
    return true;
  }

 private:
  /// False if the chain of that tip cannot be solved by itself.
  bool make_from_chain(int lead, bool at_random);

  const StackedGoal& goal_;
  ArmSearch& arms_;
  Random random_;
  Work& work_;
  TreeResult& result_;
  int index_ = 0;
  JointVector q_;
  bool is_loaded_ = false;
};

}  // namespace iksel
