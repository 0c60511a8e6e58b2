// SPDX-License-Identifier: BSD-3-Clause
// Seven joints of which one is swept over its range: for each of its values the others are known in
// closed form.
#pragma once

#include <array>
#include <vector>

#include "base/function_ref.hpp"
#include "base/work.hpp"
#include "seeds/branch_intervals.hpp"
#include "seeds/least_places.hpp"
#include "seeds/swept_branches.hpp"

namespace iksel {

class Sweep {
 public:
  /// Values of the swept joint that are looked at, evenly over its range.
  static constexpr int kSamples = 128;

  /// `chain` has a joint that is held; its limits are the model's. `is_nominal`: it is the model's
  /// own. `tolerance` is the larger of the solver's [rad, and m in units of the reach].
  Sweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal, double tolerance,
        const lanes::LaneKernels& kernels);

  /// Looks for an answer to Y (reduction.hpp): at the samples, and where branches come near to one,
  /// between them. True if there is one.
  bool find(const Pose& Y) { return find_at_samples(Y) || find_between(); }
  /// The first part of it.
  bool find_at_samples(const Pose& Y);
  /// The second part: wherever a branch comes near to an answer.
  bool find_between();
  /// Adds the branches inside the limits at every `stride`-th sample from `first` on, seven joint
  /// values each [rad].
  void add_samples(const Pose& Y, int first, int stride, std::vector<double>& q);
  /// Where find() found none: visits the joint values of the branches that came nearest to an
  /// answer at the samples, inside the limits or not.
  void visit_nearest(std::size_t most, FunctionRef<void(const JointVector&)> visit);
  /// A branch at a sample of the swept joint.
  struct Sample {
    int place, branch;
  };
  /// The same, for the target as it is set, and which they are.
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
  static constexpr double kSpacingBeside = 2.0 / (SweptBranches::kCount + 2);
  /// The answer [rad].
  [[nodiscard]] const double* q() const { return q_.data(); }
  /// If there was none: where branches came so close to one that it might have been missed.
  [[nodiscard]] std::size_t close_count() const { return close_.size(); }
  [[nodiscard]] const double* close_to_answer(std::size_t i) const { return close_[i].q.data(); }
  /// If there was none: whether none came so close to one that it might have been missed.
  [[nodiscard]] bool is_none() const { return miss_.rules_out_answers(least_); }

 private:
  static constexpr int kPacks = kSamples / SweptBranches::kCount;
  /// Branches that are followed between samples, at most. With 16, of which merged ones take four
  /// each or eight, one of 4.8 million reachable targets was lost.
  static constexpr std::size_t kFollowed = 32;
  /// And such only as come so near to an answer at a sample [mixed units].
  static constexpr double kNear = 0.3;

  /// Whether one of a sample's branches is an answer; it becomes the last one.
  bool take_answer(int place);
  /// Whether what was solved last is an answer in a lane; it becomes the last one.
  bool take(int lane, int branch);
  /// Looks between the samples beside; true if there is an answer.
  bool follow(const LeastPlace& near);
  /// Looks between all samples; true if there is an answer.
  bool find_in_intervals();
  /// Whether a branch has merged there with one that is followed, too: a closed curve that lies
  /// beside is of both.
  [[nodiscard]] bool is_left_to_another(const LeastPlace& near) const;
  /// Keeps what was solved last in lane 0, or what lies aside of it, if it comes close to an
  /// answer.
  void keep_if_close(double off, bool is_aside);

  const JointSpace& joints_;
  // sweep_spread.cpp
  class Spread;

  SweptBranches branches_;
  BranchIntervals intervals_;
  Places places_;
  NearMiss miss_;
  /// How far each branch of a sample is from being an answer [mixed units].
  std::vector<SweptBranches::Row> rows_;
  /// Where a branch comes nearer to an answer than at the samples beside.
  LeastPlaces<kFollowed> nearest_;
  Least<SweptJoints, kFollowed> close_;
  double least_ = 0;  ///< how far the nearest branch was from being an answer
  std::array<double, kCurveJoints> q_{};
  int branch_ = 0;
};

/// These as a source of seeds: an answer at a sample; where there is none, and it is asked for, one
/// between samples, and then what comes close to one.
class SweptSeeds {
 public:
  SweptSeeds(Sweep& sweep, const Pose& Y, Work& work) : sweep_(sweep), Y_(Y), work_(work) {}

  bool next_stage() {
    if (!work_.has_left() || found_ || next_part_ == Part::none) return false;
    part_ = next_part_;
    next_part_ = Part::none;
    if (part_ == Part::samples) found_ = sweep_.find_at_samples(Y_);
    if (part_ == Part::between) found_ = sweep_.find_between();
    work_.lap(&StageTimes::query);
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    const std::size_t count = part_ == Part::close ? sweep_.close_count() : found_ ? 1 : 0;
    if (next_ == count || !work_.take()) return false;
    if (found_) {
      refiner.load_answer(lane, sweep_.q());
    } else {
      refiner.load_seed(lane, sweep_.close_to_answer(next_));
    }
    ++next_;
    return true;
  }
  /// Next, it is looked between samples.
  void look_between() { next_part_ = Part::between; }
  /// Next, what was found to come close to an answer is given.
  void give_close() { next_part_ = Part::close; }
  /// Whether there is no answer, once all between the samples was looked at.
  [[nodiscard]] bool is_none() const { return !found_ && sweep_.is_none(); }

 private:
  enum class Part { none, samples, between, close };

  Sweep& sweep_;
  const Pose& Y_;
  Work& work_;
  Part part_ = Part::none;
  Part next_part_ = Part::samples;
  bool found_ = false;
  std::size_t next_ = 0;
};

}  // namespace iksel
