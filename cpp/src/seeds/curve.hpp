// SPDX-License-Identifier: BSD-3-Clause
// The self-motion of seven joints, as the arcs that lie inside the limits.
//
// An arc ends where a joint is at a limit (arc_ends.hpp). The tangent is oriented
// (curve_kernel.hpp): at one of an arc's ends it leads inside, at the other outside. From the first
// the arc is followed to the second. Curves that meet no limit are followed from samples of the
// swept joint, or else from solutions, that lie on none of these arcs; so are arcs whose ends are
// not known. How long steps
// are and what counts as the same is measured on random arms by tests/python/test_laws.py,
// test_no_answer_lies_off_the_arcs.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "seeds/arc_ends.hpp"
#include "seeds/curve_walker.hpp"
#include "seeds/sweep.hpp"

namespace iksel {

class Curve {
 public:
  using Joints = CurveWalker::Joints;
  struct Arc {
    std::vector<Joints> q;
    SelfMotionEnd begin, end;
    double length = 0;  ///< by the joint that moves most [rad]

    [[nodiscard]] bool is_closed() const { return begin.kind == ArcEnd::closed; }
  };

  Curve(const ChainModel& model, const lanes::LaneKernels& kernels)
      : joints_(model.joints), walker_(model, kernels) {}

  /// The arcs for a target, Y as in reduction.hpp; with points so near to each other that no joint
  /// moves farther than `spacing` between them [rad]. `ends` may be null, and so may `sweep` where
  /// no joint can be swept: then those that have an end, and those through `count` configurations
  /// that are known, seven joint values each.
  const std::vector<Arc>& find(const Pose& T_base_tcp, const Pose& Y, ArcEnds* ends, Sweep* sweep,
                               const double* known, std::size_t count, double spacing);
  /// About so many places evenly along these arcs, on straight lines between their points, and both
  /// ends of each; no nearer to each other along the arc than `least` [rad]. Seven joint values
  /// each.
  void spread(std::size_t count, double least, std::vector<double>& q) const;

 private:
  using Place = CurveWalker::Place;
  using Step = CurveWalker::Step;

  /// A joint at a limit.
  struct End {
    Joints q;
    SelfMotionEnd at;
    Place on_curve;            ///< oriented
    bool leads_in, leads_out;  ///< whether it leads inside, and whether it comes from there
    bool is_taken;             ///< an arc begins or ends there

    /// Whether the curve but touches the limit there, or all but that.
    [[nodiscard]] bool touches() const { return leads_in && leads_out; }
  };
  /// From an end or a sample along a curve.
  struct Walk {
    std::vector<Joints> q;
    Joints tangent;       ///< where it begins, oriented
    SelfMotionEnd begin;  ///< a fold: it begins at a sample
    bool is_reversed;     ///< against the orientation
    /// Of the walk, once it has ended, unless that is part of another.
    std::optional<std::size_t> arc;
  };

  void find_samples(const Pose& Y, Sweep& sweep);
  void find_ends(const Pose& T_base_tcp, ArcEnds& ends);

  // curve_walk.cpp
  void follow_from_ends();
  void follow_from_samples(Sweep& sweep);
  /// From between two ends, or on a curve without any, unless that is known.
  void follow_both_ways(const double* from);
  void follow(std::vector<Walk>& walks);
  /// Adds points of a step, up to a part of it, where points are to be nearer than steps are long.
  void add_between(Walk& walk, const Step& step, double end) const;
  /// Takes a further configuration. False if the walk ends there.
  bool advance(Walk& walk, int lane, const Step& step);
  /// How q lies beside the straight way between two configurations: along it, and its distance from
  /// the first, both times the way's length; squares.
  struct Beside {
    double along, way2, rest2;
  };
  [[nodiscard]] Beside beside(const Joints& from, const Joints& to, const Joints& q) const;
  /// Whether a walk comes back to where it began between its last point and the next: at that part
  /// of the way, else 0.
  [[nodiscard]] double closes_at(const Walk& walk, const Joints& next) const;
  void mark_samples(const Joints& from, const Joints& to);
  void finish(Walk& walk, const SelfMotionEnd& end);
  [[nodiscard]] bool is_on_arc(const Joints& q) const;
  /// Ends a walk at a limit.
  void leave(Walk& walk, const Joints& q, const SelfMotionEnd& at);

  void thin_out(Arc& arc, double spacing) const;

  const JointSpace& joints_;
  CurveWalker walker_;
  double spacing_ = kInfinity;  ///< of points, if they are nearer than steps are long

  // Of the last search.
  std::vector<End> ends_;
  std::vector<Place> places_of_ends_;
  const Places* places_ = nullptr;
  int swept_ = -1;
  /// Branches at samples of the swept joint, inside the limits, and their joint values.
  std::vector<Sweep::Sample> samples_;
  std::vector<double> sampled_q_;
  std::vector<bool> is_known_;  ///< that they lie on arcs that were found
  /// The first sample of each place, and the number of all.
  std::array<std::size_t, Sweep::kSamples + 1> first_sample_{};
  std::vector<Arc> arcs_;
};

}  // namespace iksel
