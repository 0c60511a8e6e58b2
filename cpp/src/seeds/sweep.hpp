// SPDX-License-Identifier: BSD-3-Clause
// Seven joints of which one is swept over its range: for each of its values the others are known in
// closed form.
#pragma once

#include <array>
#include <vector>

#include "base/work.hpp"
#include "kinematics/chain_model.hpp"
#include "simd/branch_types.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

class Sweep {
 public:
  /// Values of the swept joint that are looked at, evenly over its range.
  static constexpr int kSamples = 64;

  /// `chain` has a joint that is held; its limits are the model's. `is_nominal`: it is the model's
  /// own. `tolerance` is the larger of the solver's [rad, and m in units of the reach].
  Sweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal, double tolerance,
        const lanes::LaneKernels& kernels);

  /// Looks for an answer to Y (reduction.hpp): at the samples, and where branches come near to one,
  /// between them. True if there is one.
  bool find(const Pose& Y);
  /// The answer [rad].
  [[nodiscard]] const double* q() const { return q_.data(); }
  /// If there was none: whether none came so close to one that it might have been missed.
  [[nodiscard]] bool is_none() const { return concludes_ && least_ > close_; }

 private:
  static constexpr int kBranches = lanes::kWidth;
  /// Branches that are followed between samples, at most.
  static constexpr std::size_t kFollowed = 8;
  /// And such only as come so near to an answer at a sample [mixed units].
  static constexpr double kNear = 0.3;
  /// Of a chain other than the nominal one, and beyond such tolerances, answers lie too far from
  /// where branches are to conclude anything.
  static constexpr double kMostTolerance = 1e-4;

  /// Where a branch comes nearer to an answer than at the samples beside.
  struct Near {
    double off;
    int place, lane;
    friend bool operator<(const Near& a, const Near& b) { return a.off < b.off; }
  };
  /// How far each branch of a sample is from being an answer [mixed units].
  using Row = std::array<double, kBranches>;

  /// Solves a pack; `off` gets how far each lane is from being an answer.
  void solve(lanes::BranchPack& pack, Row& off) const;
  [[nodiscard]] const Row& row_at(int place) const;
  void find_nearest();
  /// Looks between the samples beside; true if there is an answer.
  bool follow(const Near& near);
  void take(const lanes::BranchPack& pack, double swept, int lane);

  ClosedFormChain chain_;
  const lanes::LaneKernels& kernels_;
  bool concludes_;
  /// A branch that comes so near to an answer may be one that rounding hides, or the tolerances
  /// allow: beside a fold by their root [mixed units].
  double close_;
  double lower_, step_, offset_;  ///< of the swept joint [rad]
  /// Whether the last sample is beside the first.
  bool turns_;
  std::vector<Row> rows_;
  lanes::BranchPack pack_ = all_branches();
  lanes::BranchPack followed_{};  ///< one branch in all lanes
  std::array<Near, kFollowed> nearest_{};
  std::size_t near_count_ = 0;
  double least_ = 0;  ///< how far the nearest branch was from being an answer
  std::array<double, 7> q_{};
};

/// These as a source of seeds.
class SweptSeeds {
 public:
  SweptSeeds(Sweep& sweep, const Pose& Y, Work& work, StageClock& clock)
      : sweep_(sweep), Y_(Y), work_(work), clock_(clock) {}

  bool next_stage() {
    if (done_ || !work_.has_left()) return false;
    done_ = true;
    found_ = sweep_.find(Y_);
    clock_.lap(&StageTimes::query);
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (!found_ || loaded_ || !work_.take()) return false;
    loaded_ = true;
    refiner.load_answer(lane, sweep_.q());
    return true;
  }
  /// Whether there is no answer.
  [[nodiscard]] bool is_none() const { return done_ && !found_ && sweep_.is_none(); }

 private:
  Sweep& sweep_;
  const Pose& Y_;
  Work& work_;
  StageClock& clock_;
  bool done_ = false;
  bool found_ = false;
  bool loaded_ = false;
};

}  // namespace iksel
