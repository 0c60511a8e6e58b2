// SPDX-License-Identifier: BSD-3-Clause
// Seven joints of which one is swept over its range: for each of its values the others are known in
// closed form.
#pragma once

#include <array>
#include <vector>

#include "base/function_ref.hpp"
#include "base/least.hpp"
#include "iksel/result.hpp"
#include "seeds/branch_enclosure.hpp"
#include "seeds/swept_branches.hpp"

namespace iksel {

class Sweep {
 public:
  /// Values of the swept joint that are looked at, evenly over its range.
  static constexpr int kSamples = 128;

  /// `chain` has a joint that is held; its limits are the model's. `is_nominal`: it is the model's
  /// own. Tolerances are the solver's [m, rad].
  Sweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
        double position_tolerance, double rotation_tolerance, const lanes::LaneKernels& kernels);

  /// Looks for an answer to Y (reduction.hpp), at the samples, and between them. True if there is
  /// one.
  bool find(const Pose& Y) { return find_at_samples(Y) || find_between(Y); }
  /// The first part of it, at some of the samples.
  bool find_at_samples(const Pose& Y);
  /// The second part: in each piece of the range that may have one.
  bool find_between(const Pose& Y);
  /// What was found, seven joint values each [rad or m]: an answer; if there is none, what comes
  /// nearest to one in what is left of these pieces.
  [[nodiscard]] const std::vector<double>& found() const { return found_; }
  /// If there is no answer: whether that is certain.
  [[nodiscard]] Proof proof_of_none() const;
  /// Whether the chain is the model's own: no answer is far from what may be found.
  [[nodiscard]] bool is_nominal() const { return is_nominal_; }
  /// Where there is no answer at the samples: visits the joint values of the branches that come
  /// nearest to one there, inside the limits or not.
  void visit_nearest(const Pose& Y, std::size_t most, FunctionRef<void(const JointVector&)> visit);
  /// A branch at a sample of the swept joint.
  struct Sample {
    int place, branch;
  };
  /// Adds the branches inside the limits at every `stride`-th sample from `first` on, for the
  /// target as it is set, seven joint values each [rad]; and which they are.
  void add_samples(int first, int stride, std::vector<double>& q, std::vector<Sample>& samples);
  /// Up to `count` branches inside the limits, at samples and between them, that lie far from each
  /// other and no nearer than `least`; seven joint values each [rad].
  void find_spread(const Pose& Y, std::size_t count, double least, std::vector<double>& q);
  /// Adds places of a branch towards where it leaves the limits, or ends, between a sample where it
  /// is inside and the one beside it, up or down, where it is not: the last ones are very near.
  void add_end(const Sample& inside, bool up, std::vector<double>& q);
  /// Once all samples were added: visits branches that are inside the limits between two samples,
  /// but at neither.
  void visit_between(FunctionRef<void(const double* q, int branch)> visit);
  [[nodiscard]] const Places& places() const { return places_; }
  [[nodiscard]] int joint() const { return branches_.joint(); }
  void set_target(const Pose& Y) {
    branches_.set_target(Y);
    places_ = branches_.places(kSamples);
  }
  /// Adds a branch inside the limits at values of the swept joint beside that of `from`, as far as
  /// a part of the way to the samples beside.
  void add_beside(const double* from, int branch, double part, std::vector<double>& q);
  /// How far from each other they are, as a part of that way.
  static constexpr double kSpacingBeside = 2.0 / (lanes::kWidth + 2);

 private:
  /// Branches that are followed between samples, at most. With 16, of which merged ones take four
  /// each or eight, one of 4.8 million reachable targets was lost.
  static constexpr std::size_t kFollowed = 32;
  /// And such only as come so near to an answer at a sample [mixed units].
  static constexpr double kNear = 0.3;

  /// How far from an answer a branch is, at a value of the swept joint [mixed units; rad or m].
  struct Place {
    double value, at;
    int branch;
  };

  /// Rates all branches at all places, as many as fill packs.
  void rate_samples();
  /// Finds where branches come nearer to an answer than at the samples beside: within kNear of one,
  /// and farther than `beyond`.
  void find_nearest(double beyond);
  /// Whether a branch at a value, where they are `off` an answer, is one; it becomes what is found.
  bool take_answer(const SweptBranches::Row& off, double value);
  /// Whether what was solved last is an answer in a lane; it becomes what is found.
  bool take(int lane);
  /// Looks at so many places in each piece that is open; true if there is an answer.
  bool look_in_pieces(int places);
  /// Looks closely at those that are nearer to an answer than what is beside them, and gives them;
  /// true if there is one.
  bool follow_nearest();
  /// From a place to the one nearest to an answer, up to `width` away; true if there is one.
  bool follow(Place& place, double width);
  /// How far from an answer a branch is, at value(lane), in off[lane]: where limits say nothing, as
  /// an angle may be any, below 0. True if one is an answer.
  template <typename Value>
  bool rate(int branch, const Value& value, double (&off)[lanes::kWidth]);

  const JointSpace& joints_;
  // sweep_spread.cpp
  class Spread;

  SweptBranches branches_;
  BranchEnclosure enclosure_;
  Places places_;
  bool is_nominal_;
  /// What comes so near to an answer may be one that rounding hides, or the tolerances allow:
  /// beside a fold by their root; all, if nothing can be concluded from branches [mixed units].
  double close_ = kInfinity;
  /// How far each branch of a sample is from being an answer [mixed units].
  std::vector<SweptBranches::Row> rows_;
  /// Where a branch comes nearer to an answer than at the samples beside.
  Least<LeastPlace, kFollowed> nearest_;
  std::vector<Place> looked_;
  double apart_ = 0;  ///< how far these are from each other [rad or m]
  double least_ = 0;  ///< how far the nearest of these was from being an answer
  std::vector<double> found_;
  std::array<double, kCurveJoints> q_{};
};

}  // namespace iksel
