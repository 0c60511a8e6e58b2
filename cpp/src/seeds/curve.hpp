// SPDX-License-Identifier: BSD-3-Clause
// The self-motion of seven joints, as the arcs that lie inside the limits.
//
// An arc ends where a joint is at a limit (arc_ends.hpp). The tangent is oriented
// (curve_kernel.hpp): at one of an arc's ends it leads inside, at the other outside. From the first
// the arc is followed to the second. Curves that meet no limit are followed from samples of the
// swept joint that lie on none of these arcs; so are arcs whose ends are not known. How long steps
// are and what counts as the same is measured on random arms by tests/python/test_laws.py,
// test_no_answer_lies_off_the_arcs.
#pragma once

#include <array>
#include <vector>

#include "iksel/self_motion.hpp"
#include "seeds/arc_ends.hpp"
#include "seeds/sweep.hpp"
#include "simd/curve_types.hpp"

namespace iksel {

class Curve {
 public:
  static constexpr int kDof = lanes::kCurveJoints;
  using Joints = std::array<double, kDof>;
  struct Arc {
    std::vector<Joints> q;
    SelfMotionEnd begin, end;
    double length = 0;  ///< by the joint that moves most [rad]

    [[nodiscard]] bool is_closed() const { return begin.kind == ArcEnd::closed; }
  };

  Curve(const ChainModel& model, const lanes::LaneKernels& kernels);

  /// Finds the arcs for a target, Y as in reduction.hpp; with points so near to each other that no
  /// joint moves farther than `spacing` between them [rad]. `ends` may be null.
  void find(const Pose& T_base_tcp, const Pose& Y, ArcEnds* ends, Sweep& sweep, double spacing);
  [[nodiscard]] const std::vector<Arc>& arcs() const { return arcs_; }
  /// About so many places evenly along these arcs, on straight lines between their points, and both
  /// ends of each; no nearer to each other along the arc than `least` [rad].
  [[nodiscard]] std::vector<Joints> spread(int count, double least) const;

 private:
  static constexpr int kLanes = lanes::kWidth;

  /// A limit of a joint, or of several together.
  struct Limit {
    SelfMotionEnd at;       ///< but for the side
    const CoupledRow* row;  ///< null: a joint's
    double lower, upper;

    [[nodiscard]] double value(const Joints& q) const {
      return row != nullptr ? row->sum(q.data()) : q[static_cast<std::size_t>(at.joint)];
    }
  };
  /// A joint at a limit.
  struct End {
    Joints q;
    SelfMotionEnd at;
    Joints on_curve;           ///< but for rounding, where it is near
    Joints tangent;            ///< oriented
    bool leads_in, leads_out;  ///< whether it leads inside, and whether it comes from there
    bool is_taken;             ///< an arc begins or ends there
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  /// What a lane follows.
  struct Walk {
    std::vector<Joints> q;
    Joints tangent;       ///< at the last, the way that it goes
    SelfMotionEnd begin;  ///< a fold: it begins at a sample
    bool is_reversed;     ///< against the orientation
    /// Of the walk, once it has ended; kNone if that is part of another.
    std::size_t arc = kNone;
  };
  /// A configuration between two of a walk, where it leaves a limit.
  struct Exit {
    double part;  ///< of the way; above 1: it does not
    SelfMotionEnd at;
  };
  /// What a lane goes from one configuration to the next: a cubic for each joint.
  struct Step {
    const Joints &from, &tangent_from, &to, &tangent_to;
    double way;

    [[nodiscard]] Joints at(double part) const;
  };
  /// What lies beyond a limit by no more is at it [rad or m].
  static constexpr double kAtLimit = 1e-7;

  void find_samples(const Pose& Y, Sweep& sweep);
  void find_ends(const Pose& T_base_tcp, ArcEnds& ends);
  /// Finds where so many are on the curve, at most as there are lanes, and their tangents.
  void orient(End* ends, std::size_t count);
  [[nodiscard]] bool is_inside(const Joints& q) const;
  [[nodiscard]] Joints sample(std::size_t i) const;

  // curve_walk.cpp
  static Walk walk_from(const End& end, bool is_reversed);
  void follow_from_ends();
  void follow_from_samples(Sweep& sweep);
  /// From between two ends, or on a curve without any, unless that is known.
  void follow_both_ways(const Joints& from);
  /// Follows these, as many at a time as there are lanes.
  void follow(std::vector<Walk>& walks);
  void start(const Walk& walk, int lane);
  /// Takes a further configuration. False if the walk ends there.
  bool advance(Walk& walk, int lane);
  /// How q lies beside the straight way between two configurations: along it, and its distance from
  /// the first, both times the way's length; squares.
  struct Beside {
    double along, way2, rest2;
  };
  [[nodiscard]] Beside beside(const Joints& from, const Joints& to, const Joints& q) const;
  [[nodiscard]] bool is_closed(const Walk& walk, const Joints& next) const;
  void mark_samples(const Joints& from, const Joints& to);
  void finish(Walk& walk, const SelfMotionEnd& end);
  [[nodiscard]] bool is_on_arc(const Joints& q) const;

  // curve_exit.cpp
  [[nodiscard]] Exit exit(const Step& step);
  /// Where one of a step's values leaves a limit, if that is before `first`.
  void look_at_limit(const Limit& limit, const Step& step, Exit& first);
  /// What lies beside a curve, on it but for rounding.
  [[nodiscard]] Joints corrected(const Joints& q);
  /// Goes on at another image, if coupled limits hold there.
  bool turn_round(Walk& walk, int lane, const Joints& next);
  /// Ends a walk at a limit.
  void leave(Walk& walk, const Joints& q, const SelfMotionEnd& at);

  /// Leaves out arcs that are but a point of another.
  void drop_points();
  void thin_out(Arc& arc, double spacing) const;

  const JointSpace& joints_;
  const lanes::LaneKernels& kernels_;
  lanes::LaneChain chain_;
  std::vector<Limit> limits_;

  // Of the last search.
  lanes::CurvePack pack_{}, probe_{};
  std::vector<End> ends_;
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
