// SPDX-License-Identifier: BSD-3-Clause
// How far joints move between configurations, by the norm and weights that are asked for.
#pragma once

#include <cmath>
#include <optional>
#include <utility>

#include "base/function_ref.hpp"
#include "iksel/request.hpp"

namespace iksel {

/// Those that are given, or else 1 for each joint.
inline JointVector weights_or_ones(const JointVector& weights, Eigen::Index dof) {
  return weights.size() == 0 ? JointVector(JointVector::Ones(dof)) : weights;
}

class JointMove {
 public:
  JointMove(int dof, const AnswerCriteria& criteria)
      : weights_(weights_or_ones(criteria.weights, dof)), norm_(criteria.norm) {}
  explicit JointMove(JointVector weights, MoveNorm norm = MoveNorm::two)
      : weights_(std::move(weights)), norm_(norm) {}

  [[nodiscard]] double length(const JointVector& difference) const {
    const auto weighted = weights_.cwiseProduct(difference);
    return norm_ == MoveNorm::two ? weighted.norm() : weighted.cwiseAbs().maxCoeff();
  }
  /// What other joints may move by where these make up a part of the whole.
  [[nodiscard]] double rest(double whole, double part) const {
    if (part >= whole) return 0;
    return norm_ == MoveNorm::two ? std::sqrt((whole - part) * (whole + part)) : whole;
  }
  [[nodiscard]] const JointVector& weights() const { return weights_; }
  [[nodiscard]] MoveNorm norm() const { return norm_; }

 private:
  JointVector weights_;
  MoveNorm norm_;
};

/// Weights by which a step of length 1 is as long as the time allows, in the max norm. Joints that
/// may take any count as the fastest of the others.
JointVector weights_of_time(const JointVector& longest);

/// A configuration, and how far others are from it.
struct NearestTo {
  JointVector from;
  JointMove move;

  /// Whether a joint does more than decide between what is equally good by the others.
  [[nodiscard]] bool prefers(int joint) const {
    constexpr double kDecides = 1e-4;
    return move.weights()[joint] > kDecides * move.weights().maxCoeff();
  }
};

/// What a request wants the answer nearest to, if it is a configuration: that of an objective near
/// a posture, or else `near`. Joints without weight in the objective decide between answers that
/// are equally good, as `near` would if there is one.
std::optional<NearestTo> find_nearest_to(int dof, const SolveRequest& request);

/// Value of a cost at q; also its gradient, and the diagonal of a positive approximation of its
/// second derivative, if they are not null.
using JointCost =
    FunctionRef<double(const JointVector& q, JointVector* gradient, JointVector* curvature)>;

/// Half the squared weighted move from a configuration, or for the max norm a p-norm near to it. A
/// joint without weight still has a little, so that it does not drift.
class MoveCost {
 public:
  /// Of the largest weight.
  static constexpr double kLeastWeight = 1e-6;

  MoveCost(const JointVector& weights, const JointVector& from, double power = 2);

  /// The gradient, and the diagonal of a positive approximation of the second derivative, if they
  /// are not null.
  double operator()(const JointVector& q, JointVector* gradient, JointVector* curvature) const;

 private:
  JointVector from_;
  double power_;
  JointVector weights_;
};

}  // namespace iksel
