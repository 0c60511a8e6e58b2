// SPDX-License-Identifier: BSD-3-Clause
// Limits of joint values as rows, lower <= c . q <= upper: of a joint, whose c is a one among zeros
// and is not stored, and of sums of joint values, which coupled limits bound.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "iksel/coupled_limit.hpp"
#include "iksel/types.hpp"

namespace iksel {

struct Limit {
  int joint = -1;          ///< -1: of a sum
  int coupled_limit = -1;  ///< of a sum: its number in RobotOptions::coupled_limits
  JointVector c;           ///< of a sum: coefficients, one for each joint
  double lower, upper;     ///< [rad or m]; of a sum no farther than the joints' own let it go
  double size = 1;         ///< sum of the coefficients' sizes
  double rounding = 0;     ///< what is held to a bound is held so far inside of it

  [[nodiscard]] double value(const double* q) const { return joint < 0 ? sum(q) : q[joint]; }
  [[nodiscard]] double sum(const double* q) const;
  /// How far a value lies outside, below 0 if it lies inside [rad or m].
  [[nodiscard]] double beyond(double value) const { return std::max(lower - value, value - upper); }
  /// What is held to a bound.
  [[nodiscard]] double held_at(bool at_upper) const {
    return at_upper ? upper - rounding : lower + rounding;
  }
  /// The coefficients of all joints.
  [[nodiscard]] JointVector row(int dof) const {
    return joint < 0 ? c : JointVector(JointVector::Unit(dof, joint));
  }
};

/// Whether all values lie inside.
bool contain(const std::vector<Limit>& limits, const double* q);

/// So often a configuration is drawn again whose sums are outside.
inline constexpr int kMostDraws = 1000;

/// The limits that a configuration stands at and is led beyond.
struct ActiveLimits {
  JointVector free;  ///< of each joint 0 if its own is one of them, else 1
  /// Of the sums, over the joints that are free: a column for each, unit vectors across each other.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor | Eigen::DontAlign, kMaxDof,
                kMaxCoupledLimits>
      across;
};

class LimitSet {
 public:
  explicit LimitSet(int dof = 0) : lower(dof), upper(dof) {}

  [[nodiscard]] int dof() const { return static_cast<int>(lower.size()); }

  /// Calls visit(limit) with that of each joint, then with that of each sum.
  template <typename Visit>
  void visit_limits(const Visit& visit) const {
    for (int j = 0; j < dof(); ++j) visit(Limit{j, -1, {}, lower[j], upper[j]});
    for (const Limit& sum : sums) visit(sum);
  }
  /// That of a joint, or with -1 that of a coupled limit.
  [[nodiscard]] Limit limit(int joint, int coupled_limit) const;

  /// True if every value lies inside, both ends included.
  [[nodiscard]] bool contains(const double* q) const;
  /// Whether all sums lie inside.
  [[nodiscard]] bool contains_sums(const double* q) const { return contain(sums, q); }
  /// Each joint at its limit if it is beyond; and where a sum is outside then, moved along its
  /// coefficients until none is.
  [[nodiscard]] JointVector clamp(const JointVector& q) const {
    JointVector inside = q.cwiseMax(lower).cwiseMin(upper);
    if (!sums.empty()) hold_sums(inside);
    return inside;
  }
  /// Moves q, whose joints lie inside their own limits, so that sums do too.
  void hold_sums(JointVector& q) const;
  /// How far each joint lies outside its own limits, 0 inside [rad or m].
  [[nodiscard]] JointVector violations(const JointVector& q) const {
    return (lower - q).cwiseMax(q - upper).cwiseMax(0.0);
  }
  /// The limits that q stands at and that `pull` leads it beyond. `is_held(joint)`: false where the
  /// joint's own is to be passed over.
  template <typename IsHeld>
  [[nodiscard]] ActiveLimits active(const JointVector& q, JointVector pull,
                                    const IsHeld& is_held) const {
    ActiveLimits at{JointVector::Ones(dof()), {}};
    for (int j = 0; j < dof(); ++j) {
      const bool leaves = (q[j] <= lower[j] && pull[j] < 0) || (q[j] >= upper[j] && pull[j] > 0);
      if (leaves && is_held(j)) at.free[j] = pull[j] = 0;
    }
    if (!sums.empty()) add_active_sums(q, pull, at);
    return at;
  }
  /// The middle of the limits; 0 where there are none.
  [[nodiscard]] JointVector middle() const;

  JointVector lower, upper;  ///< of joints [rad or m]; infinite for continuous ones
  std::vector<Limit> sums;
  JointVector interior;  ///< well inside all limits, if there are sums

 private:
  void add_active_sums(const JointVector& q, JointVector& pull, ActiveLimits& at) const;
};

}  // namespace iksel
