// SPDX-License-Identifier: BSD-3-Clause
// The self-motion of seven joints of which one is swept, as the arcs that lie inside the limits.
//
// A branch exists over spans of the swept joint. Inside a span the other joints follow evenly from
// the part of the way (BranchSpan::value); what lies inside the limits are pieces of it. Pieces
// that end where two branches merge are joined there: the curve turns back, and goes on in the
// other branch.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "iksel/self_motion.hpp"
#include "seeds/swept_branches.hpp"

namespace iksel {

class SelfMotionArcs {
 public:
  using Joints = std::array<double, SweptBranches::kDof>;
  struct Arc {
    std::vector<Joints> q;
    SelfMotionEnd begin, end;
    double length = 0;  ///< by the joint that moves most [rad]
  };

  SelfMotionArcs(const ChainModel& model, const ClosedFormChain& chain,
                 const lanes::LaneKernels& kernels);

  /// Finds the arcs for Y (reduction.hpp), with points so near to each other that no joint moves
  /// farther than `spacing` between them [rad].
  void find(const Pose& Y, double spacing);
  [[nodiscard]] const std::vector<Arc>& arcs() const { return arcs_; }
  /// About so many places evenly along these arcs, on straight lines between their points, and both
  /// ends of each; no nearer to each other along the arc than `least` [rad].
  [[nodiscard]] std::vector<Joints> spread(int count, double least) const;

 private:
  static constexpr int kSamples = 64;
  static constexpr int kLanes = SweptBranches::kCount;
  /// In which the end of a branch is looked for.
  static constexpr int kEndRounds = 8;

  /// What a function may come down to between three values of it: it may bend as sharply as where
  /// one limit takes over from another.
  static double lowest_between(double left, double here, double right) {
    return here - std::max(left - here, right - here);
  }

  /// A value of the swept joint and whether a branch exists there.
  struct Mark {
    double value;
    bool exists;
  };
  /// A branch at a part of a span.
  struct Node {
    double part = 0;
    /// How far the joint that is farthest lies outside of its limits, below 0 if none does [rad].
    double beyond = 0;
    Joints q{};
  };
  /// What of a span lies inside the limits.
  struct Piece {
    BranchSpan span;
    std::vector<Node> nodes;
    SelfMotionEnd ends[2];
    /// The piece that goes on there, and at which of its ends; -1: none.
    int next[2] = {-1, -1};
    int next_side[2] = {0, 0};
    bool is_used = false;
  };

  void sweep();
  /// Where a branch exists and where it does not, in order of the swept joint.
  void mark(int branch);
  /// Adds a mark beside a sample, if the branch comes into being, or ceases to be, between it and
  /// those beside.
  void mark_between(int branch, int place);
  void find_spans(int branch);
  void add_span(const BranchSpan& span);

  [[nodiscard]] Node node(int lane, double part) const;
  [[nodiscard]] double beyond_limits(const Joints& q) const;
  /// Nodes between two, evenly.
  std::array<Node, kLanes> nodes_between(const BranchSpan& span, const Node& a, const Node& b);
  /// Solves a span at so many parts, evenly from 0 to 1.
  void sample(const BranchSpan& span, int count);
  /// Adds nodes where joints turn far from one to the next.
  void sample_densely(const BranchSpan& span);
  /// The largest difference of a joint, whole turns of any counting nothing.
  [[nodiscard]] static double turn(const Joints& a, const Joints& b);
  /// Adds nodes where limits may be left, or come back to, between two.
  void sample_between(const BranchSpan& span);
  void cut(const BranchSpan& span);
  /// As SweptBranches::jumps, from one node to the next.
  [[nodiscard]] bool jumps(const Joints& a, const Joints& b) const {
    return branches_.jumps(a.data(), b.data());
  }
  /// The last node inside the limits on the way to a part; and what ends it there.
  Node find_end(const BranchSpan& span, const Node& inside, double outside, SelfMotionEnd& end);
  [[nodiscard]] SelfMotionEnd culprit(const Joints& inside, const Joints& outside) const;
  /// What ends a piece that reaches an end of its span.
  [[nodiscard]] SelfMotionEnd end_of_span(const BranchSpan& span, int side) const;

  void join();
  /// Adds spans that merge with a piece where nothing was found that does.
  void find_partners();
  bool add_partner(int branch, const BranchSpan& span, double part, const Joints& fold);
  void chain(double spacing);
  /// The arc that begins at a side of a piece, unless that is part of another already.
  void follow(int first, int side, double spacing);
  void append(const Piece& piece, bool backwards, double spacing, Arc& arc);
  void append_between(const BranchSpan& span, const Node& a, const Node& b, double spacing,
                      int depth, Arc& arc);
  void finish(Arc& arc, double spacing) const;

  SweptBranches branches_;
  Places places_;
  const JointSpace& joints_;

  // Of the last search.
  std::vector<SweptBranches::Row> least_;
  std::vector<Mark> marks_;
  std::vector<Node> nodes_;
  std::vector<BranchSpan> spans_;
  std::vector<Piece> pieces_;
  std::vector<Arc> arcs_;
  int splits_left_ = 0;  ///< of pieces between two nodes
};

}  // namespace iksel
