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

  /// `straight`: where joint 5 turns axes 4 and 6 into one line, as it does half a turn from there;
  /// NaN: nowhere [rad].
  MoveBounds(const lanes::MoveForm& form, double straight) : form_(form), straight_(straight) {}

  /// Joints turn far that turn by more [rad], and by more than so many times what the swept one
  /// does.
  static constexpr double kWide = 0.7;
  static constexpr double kSteeper = 4;
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

  /// The curve is longer than a straight line by no more than half as much again.
  static constexpr double kCurved = 1.5;
  /// Whether there may be a shorter move than `best` to an answer between two points that are such
  /// a way apart.
  [[nodiscard]] static bool may_be_shorter(const BranchPoint& a, const BranchPoint& b,
                                           const Way& way, double best) {
    const double loose = way.leaves_limits ? 2 * std::min(a.loose, b.loose) : a.loose + b.loose;
    return loose - kCurved * way.move <= 2 * best && a.off + b.off - kCurved * way.largest <= 0;
  }

  /// The same of each joint by itself.
  [[nodiscard]] bool joints_may_be_shorter(const BranchPoint& a, const BranchPoint& b,
                                           double best) const {
    const Way way = this->way(a, b);
    return may_be_shorter(a, b, way, best) && between(a, b, way, best).move < kInfinity;
  }

  /// Whether there may be one that neither point tells of: joints turn far between them, or one may
  /// meet a limit there, where the branch enters the limits or another image is the nearest.
  /// `usual`: what else joints turn between such points [rad].
  [[nodiscard]] bool may_hide_shorter(const BranchPoint& a, const BranchPoint& b, const Way& way,
                                      double usual, double best) const;

  /// Whether a branch that is so far from being at two points (BranchPoint::least) may be between
  /// them, where that changes by as much as `rise` from one point to the next.
  [[nodiscard]] static bool may_be_between(double a, double b, double rise) {
    return std::max(a, b) >= 0 || -a - b <= kCurved * rise;
  }
  /// Two points, at one of which a branch does not exist, or at neither; and those beside them,
  /// null where these are not known.
  struct Gap {
    const BranchPoint* before;
    const BranchPoint &a, &b;
    const BranchPoint* behind;
  };
  /// Whether there may be a shorter move than `best` where the branch exists between them.
  [[nodiscard]] bool may_be_shorter(const Gap& gap, double best) const;

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
  /// The least move of each joint between two points, together, and whether one may meet a limit;
  /// infinite if it is not less than `best`.
  [[nodiscard]] Reach between(const BranchPoint& a, const BranchPoint& b, const Way& way,
                              double best) const;
  /// The same where they may turn `beyond(joint, turn)` beyond both.
  template <typename Beyond>
  [[nodiscard]] Reach between(const BranchPoint& a, const BranchPoint& b, const Beyond& beyond,
                              double best) const;
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
  double straight_;
};

}  // namespace iksel
