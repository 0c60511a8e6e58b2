// SPDX-License-Identifier: BSD-3-Clause
// The least joint move to the self-motion of seven joints of which one is swept: of the whole curve
// inside the limits, not only down from where a seed happens to end.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/function_ref.hpp"
#include "base/least.hpp"
#include "goal/joint_move.hpp"
#include "seeds/move_bounds.hpp"
#include "seeds/swept_branches.hpp"

namespace iksel {

class NearestOnCurve {
 public:
  /// As Sweep.
  NearestOnCurve(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
                 const lanes::LaneKernels& kernels);

  /// Looks for the local minima of the move from `near` to answers to Y (reduction.hpp), each at
  /// its nearest periodic image. Only as far from `near` as an answer may be nearer than those
  /// found, and than one that is known whose move is `known`; none: infinity. `takes_doubtful`:
  /// also to what is at a limit, which refining may move beyond it.
  void find(const Pose& Y, const JointVector& near, const JointMove& move, double known,
            bool takes_doubtful) {
    find_at_samples(Y, near, move, known, takes_doubtful);
    find_between(known);
  }
  /// The first part of it; returns whether an answer was seen.
  bool find_at_samples(const Pose& Y, const JointVector& near, const JointMove& move, double known,
                       bool takes_doubtful);
  /// The second part.
  void find_between(double known);
  /// Whether nothing that matters is nearer than what leaves the swept joint where it is: moves of
  /// the others do but decide between such.
  [[nodiscard]] bool prefers_staying(const JointMove& move) const;
  [[nodiscard]] std::size_t size() const { return found_.size(); }
  /// The nearest first [rad].
  [[nodiscard]] const double* q(std::size_t i) const { return found_[i].q.data(); }
  /// The move to it.
  [[nodiscard]] double move(std::size_t i) const { return found_[i].value; }
  /// Whether there may be more than what was found, as curves cross where the arm is singular
  /// (python -m bench moves --odd): joints swing there, or what was found is an answer but for
  /// rounding; or the curve is degenerate.
  [[nodiscard]] bool is_in_doubt() const { return is_in_doubt_ || is_degenerate_; }
  /// Whether at a sample branches are the same, or answers, but for rounding, or between two that
  /// are all but the same joints turn far.
  [[nodiscard]] bool is_degenerate() const { return is_degenerate_; }
  /// Whether these are local minima but for rounding: those of the chain itself.
  [[nodiscard]] bool is_settled() const { return is_nominal_; }

 private:
  // Measured on random arms by `python -m bench moves`.

  /// As many as bits of a word.
  static constexpr int kSamples = 64;
  static constexpr std::size_t kMost = 8;
  /// What is no answer counts more than any move, and the more the farther it is from one.
  static constexpr double kRefused = 1e9;
  static constexpr BranchPoint kNone{{}, 0, 0, kInfinity, 0};
  /// The move to where the curve ends may be so much shorter than at the sample before.
  static constexpr double kSteep = 0.3;
  /// So far from an answer is what a search ends at beside a point that is all there is of the
  /// curve [mixed units].
  static constexpr double kCorner = 1e-5;
  /// Rounds of eight values in which a least is looked for, and to which part of a sample's
  /// distance from the next.
  static constexpr int kNarrowings = 9;
  static constexpr double kFinest = 1e-5;
  /// Levels of spans within spans, each a seventh of the one above: to 1e-5 of a sample's.
  static constexpr int kDeepest = 6;
  /// And so many in all: where joints may be any at every sample, each span would have seven.
  static constexpr int kMostSpans = 128;
  /// Branches are followed only if they come so near to an answer at a sample [mixed units].
  static constexpr double kNear = 0.2;
  /// Nor is there anything beside samples that are so much farther away than what is known [rad].
  static constexpr double kFarther = 0.1;
  /// The first and last lane of each byte: of a joint in what BranchRow has of limits, of a pack in
  /// the bits of places.
  static constexpr std::uint64_t kFirstLanes = 0x0101010101010101;
  static constexpr std::uint64_t kLastLanes = kFirstLanes << (lanes::kWidth - 1);

  /// Every branch at lanes::kWidth samples of the swept joint beside each other.
  struct SamplePack {
    bool is_solved = false;
    lanes::BranchRow branch[lanes::kWidth];
  };

  /// A move, or more than kRefused where that is so far from an answer.
  [[nodiscard]] static double cost(double inside, double off) {
    return off > 0 ? kRefused + off : inside;
  }
  /// Of a branch at a sample; infinite where it is not known to be.
  [[nodiscard]] double cost(int place, int branch) const {
    return exists(place, branch) ? cost(point(place, branch)) : kInfinity;
  }
  [[nodiscard]] static double cost(const BranchPoint& point) {
    return cost(point.inside, point.off);
  }
  /// At least how long the move is to any answer at a value of the swept joint; and how much less
  /// that may be one sample nearer.
  [[nodiscard]] double least_move(double value) const;
  [[nodiscard]] double margin_of_step() const { return weight_ * places_.step; }
  /// The shortest move so far; infinite if there is none.
  [[nodiscard]] double best() const {
    return found_.size() > 0 ? std::min(found_[0].value, known_move_) : known_move_;
  }
  /// Adds what leaves the swept joint at `near`.
  void stay();
  /// Solves the samples from the one nearest to `near` on, as far as it may be worth it; the
  /// shortest move there.
  double look_around();
  /// Solves a pack of samples, as far as their moves may be worth it beside one that is known; the
  /// shortest move there.
  double solve_pack(int pack, double best);
  /// Whether a sample was solved; places count by whole turns of the swept joint.
  [[nodiscard]] bool is_known(int place) const {
    const int at = places_.find(place);
    return at >= 0 && packs_[static_cast<std::size_t>(at / lanes::kWidth)].is_solved;
  }
  /// A branch at one that was.
  [[nodiscard]] BranchPoint point(int place, int branch) const {
    const int at = places_.find(place);
    const SamplePack& pack = packs_[static_cast<std::size_t>(at / lanes::kWidth)];
    return branches_.point(places_.value(at), pack.branch[branch], at % lanes::kWidth);
  }
  [[nodiscard]] MoveBounds bounds() const { return branches_.bounds(); }
  [[nodiscard]] bool exists(int place, int branch) const {
    const int at = places_.find(place);
    return at >= 0 && (exist_[static_cast<std::size_t>(branch)] >> at & 1U) != 0;
  }
  /// Whether there may be a shorter move than the best so far beside a sample.
  [[nodiscard]] bool may_be_shorter(const LeastPlace& least) const;
  void follow(const LeastPlace& least);
  /// Values of the swept joint between which a branch is looked into, at lanes::kWidth nodes.
  struct BranchSpan {
    int branch;
    double lower, upper;  ///< [rad or m]

    [[nodiscard]] double spacing() const { return (upper - lower) / (lanes::kWidth - 1); }
    [[nodiscard]] double value(int node) const { return lower + spacing() * node; }
  };
  /// Adds the least of a branch up to `width` to both sides of a value, inside the span, or `best`
  /// if that is less. It is looked for at lanes::kWidth values a round, each round around the least
  /// so far; the search ends early where `is_enough(cost, round)`.
  void add_least(const BranchSpan& span, double middle, double width, const BranchPoint& best,
                 FunctionRef<bool(double, int)> is_enough);
  /// Adds a point, if it is an answer or all but: where two joints are at limits that let neither
  /// move on, it may be all there is of the curve.
  void add(const BranchPoint& point);
  void look_between_samples();
  /// Looks before those places of each branch, given as bits by places_of(branch).
  template <typename Places>
  void visit_gaps(const Places& places_of);
  /// Whether there may be a shorter move than the best so far there that the samples do not tell
  /// of.
  [[nodiscard]] bool may_hide_shorter(int place, int branch) const;
  /// Bits of the places behind these.
  [[nodiscard]] std::uint64_t behind(std::uint64_t places) const {
    return places << 1 | (places_.turns ? places >> (kSamples - 1) : 0);
  }
  /// And of those before.
  [[nodiscard]] std::uint64_t before(std::uint64_t places) const {
    return places >> 1 | (places_.turns ? places << (kSamples - 1) : 0);
  }
  /// The samples between which and those before a branch that is at neither may be, as bits.
  [[nodiscard]] std::uint64_t find_loops(int branch) const;
  /// The samples from which to the next a joint stays beyond the same limit, as bits.
  [[nodiscard]] std::uint64_t find_staying(int branch) const;
  /// Looks for the least moves in a span, at its nodes, and between these where there may be
  /// shorter ones that they do not tell of, down to so many levels.
  bool look_into(const BranchSpan& span, int depth);
  /// Looks for the least move around a node of a span, as far as those beside it, which are up to
  /// `way` away.
  void follow(const BranchSpan& span, int node, const MoveBounds::Way& way);
  /// Whether there may be a shorter move than the best so far such a way around one of that cost.
  [[nodiscard]] bool may_lead_to_shorter(double cost, const MoveBounds::Way& way) const;

  SweptBranches branches_;
  Places places_;
  bool is_nominal_;

  // Of the last search.
  double near_ = 0, weight_ = 0;  ///< of the swept joint
  /// The samples at which all joints of a branch are known, at which it is far, and at which it is
  /// not, as bits.
  std::array<std::uint64_t, lanes::kWidth> exist_{}, far_{}, none_{};
  /// Those at which by the joints known it may be near enough.
  std::array<std::uint64_t, lanes::kWidth> within_{};
  double known_move_ = 0;
  bool takes_largest_ = false;
  bool stays_ = false;  ///< all that matters is found at one value of the swept joint
  bool is_in_doubt_ = false;
  bool is_degenerate_ = false;
  int spans_left_ = 0;
  std::vector<SamplePack> packs_;
  Least<SweptJoints, kMost> found_;
};

}  // namespace iksel
