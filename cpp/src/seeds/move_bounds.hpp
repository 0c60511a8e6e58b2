// SPDX-License-Identifier: BSD-3-Clause
// How short a move may be to what lies between two points of a branch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angle.hpp"
#include "base/constants.hpp"
#include "simd/branch_types.hpp"

namespace iksel {

/// What is known of a branch at a value of the swept joint.
struct BranchPoint {
  /// Six joints as a form counts them, and the swept one [rad or m]; NaN where not known.
  std::array<double, 7> q;
  double least;   ///< below 0 it does not exist, and joints are where it comes nearest to
  double loose;   ///< the move to it by each joint's nearest image
  double inside;  ///< by the nearest inside the limits
  double off;     ///< how far it is from being an answer [mixed units]

  [[nodiscard]] bool exists() const { return least >= 0; }
  /// Whether not all joints are known, as some are far from an answer, or that far to be moved.
  [[nodiscard]] bool is_far() const { return inside >= lanes::kFarAway; }
  /// Whether a limit keeps its joints from the images that are nearest.
  [[nodiscard]] bool is_blocked() const { return off > 0 || inside > loose + kSameAnswer; }
};

/// Of the moves that a form measures. Its constants are measured on random arms by
/// `python -m bench moves`.
class MoveBounds {
 public:
  using Joints = std::array<double, 7>;

  /// For each of six joints the angle at which it turns the axes beside it into one line, as it
  /// does half a turn from there; NaN: nowhere [rad].
  using Straight = std::array<double, 6>;
  MoveBounds(const lanes::MoveForm& form, const Straight& straight)
      : form_(form), straight_(straight) {}

  /// Between two points joints turn far that turn by more: what is shortest may be far from both
  /// [rad].
  static constexpr double kWide = 0.7;
  /// What is shorter by less is not looked for [rad].
  static constexpr double kTooLittle = 1e-3;
  /// What turns by no more takes no part in a swing, and what stands still turns by less [rad].
  static constexpr double kStill = 0.1;
  static constexpr double kStanding = 1e-4;
  /// How far the joints are from one point to another, by nearest images: as a move, and the one
  /// that turns most [rad].
  struct Way {
    double move, largest;
    /// Whether a joint turns from one limit beyond the other.
    bool leaves_limits = false;
    /// What turns most of those that take no part in a swing [rad].
    double rest = 0;

    /// Whether joints swing: they turn against each other while all others all but stand still.
    [[nodiscard]] bool is_swing() const { return largest > kStill && rest < kStanding; }
  };
  [[nodiscard]] Way way(const BranchPoint& a, const BranchPoint& b) const {
    Way way{0, 0};
    Norm norm(form_);
    for (std::size_t i = 0; i < a.q.size(); ++i) {
      const double d = std::abs(a.q[i] - b.q[i]);
      if (std::isnan(d)) continue;
      const double turn = form_.turns[i] ? std::min(d, std::abs(kTwoPi - d)) : d;
      way.largest = std::max(way.largest, turn);
      if (turn <= kStill) way.rest = std::max(way.rest, turn);
      way.leaves_limits = way.leaves_limits || (turn < d && !form_.has_images[i]);
      norm.add(i, turn);
    }
    way.move = norm.value();
    return way;
  }

  /// Whether there may be a shorter move than `best` between two points that are such a way apart,
  /// as far as that can be told sooner than by may_hide_shorter().
  [[nodiscard]] bool may_be_shorter(const BranchPoint& a, const BranchPoint& b, const Way& way,
                                    double best) const;

  /// Two points of a branch beside each other, which may exist at one of them only or at neither,
  /// and those before and behind, null where these are not known.
  struct Gap {
    const BranchPoint* before;
    const BranchPoint &a, &b;
    const BranchPoint* behind;

    /// Whether the branch exists at both.
    [[nodiscard]] bool exists() const { return a.exists() && b.exists(); }
  };
  /// Whether there may be a shorter move than `best` between the two that neither tells of: the
  /// branch may end there, joints may turn far, or one may meet a limit, where the branch enters
  /// the limits or another image is the nearest.
  [[nodiscard]] bool may_hide_shorter(const Gap& gap, double best) const;

  /// How far between two places a quantity may lie beyond its values at both, by what it changes by
  /// from the one to the other, to the first and from the second; NaN: not known. Of a parabola
  /// that is an eighth of what its changes differ by; this is twice that.
  [[nodiscard]] static double beyond(double change, double before, double behind) {
    constexpr double kBend = 0.25;
    double bend = std::isnan(before) && std::isnan(behind) ? std::abs(change) : 0;
    for (const double beside : {before, behind}) {
      const double one = std::abs(change - beside);
      if (one > bend) bend = one;
    }
    return kBend * bend;
  }

  /// The nearest on the way from a point to another by such turns where joints swing: all of it is
  /// on the curve, one way round and the other.
  [[nodiscard]] BranchPoint nearest_on_swing(const BranchPoint& from, Joints turns) const;

 private:
  /// The nearest that is inside the limits.
  [[nodiscard]] BranchPoint nearest_on_line(const Joints& from, const Joints& turns) const;
  /// The move to the joints' nearest images inside the limits; infinite if there are none.
  [[nodiscard]] double inside_move(const Joints& q) const;
  /// The least that joints move to a range of values, and whether these meet a limit.
  struct Reach {
    double move;
    bool meets_limit;
  };
  /// The values of a joint between two points; NaN where not known [rad or m]. `ends`: the branch
  /// may end there.
  struct Range {
    double low, high;
  };
  [[nodiscard]] Range range(const Gap& gap, std::size_t joint, bool ends) const;
  /// The joints, as bits, that may turn as they like beside an end there, as their axes come into
  /// one line.
  [[nodiscard]] unsigned swinging(const Gap& gap) const;
  /// Of a joint to any image of the values from `low` to `high` that is inside the limits, or so
  /// far outside [rad or m].
  [[nodiscard]] Reach reach(std::size_t joint, double low, double high, double outside) const;
  /// What a joint turns from one value to another, the shorter way round.
  [[nodiscard]] double turn(std::size_t joint, double from, double to) const {
    return form_.turns[joint] ? without_turns(to - from) : to - from;
  }

  /// What joints move by, together.
  class Norm {
   public:
    explicit Norm(const lanes::MoveForm& form) : form_(form) {}
    void add(std::size_t joint, double way) {
      const double move = form_.weight[joint] * way;
      largest_ = std::max(largest_, move);
      squares_ += move * move;
    }
    [[nodiscard]] bool is_below(double move) const {
      return form_.takes_largest ? largest_ < move : squares_ < move * move;
    }
    [[nodiscard]] double value() const {
      return form_.takes_largest ? largest_ : std::sqrt(squares_);
    }

   private:
    const lanes::MoveForm& form_;
    double largest_ = 0;
    double squares_ = 0;
  };

  const lanes::MoveForm& form_;
  const Straight& straight_;
};

}  // namespace iksel
