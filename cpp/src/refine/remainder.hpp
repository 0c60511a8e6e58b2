// SPDX-License-Identifier: BSD-3-Clause
// How much is missing of a goal at a configuration, and its derivatives.
#pragma once

#include "goal/goal.hpp"
#include "iksel/request.hpp"
#include "simd/lane_chain.hpp"

namespace iksel {

using SquareMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, kMaxDof, kMaxDof>;

/// The weights of position [1/m] and rotation [1/rad].
/// `rotation`: those that are not given [1/rad].
Vector6 to_vector(const PoseWeights& weights, double rotation);

/// How far a configuration is from a goal: half the squared length of what is missing, each part of
/// it times its weight; of several tips, what is missing of all.
class Remainder {
 public:
  /// `weights` of position [1/m] and rotation [1/rad] along the axes of the task. All must outlive
  /// this.
  Remainder(const Goal& goal, const Vector6& weights)
      : goal_(goal),
        model_(goal.model()),
        weights2_(weights.cwiseAbs2()),
        is_simple_(goal.tips() == nullptr && is_simple(model_)),
        turns_alike_((weights2_.tail<3>().array() == weights2_[3]).all()) {}

  [[nodiscard]] const Goal& goal() const { return goal_; }
  [[nodiscard]] double value(const JointVector& q) const;
  /// Also its gradient, and the Gauss-Newton approximation's diagonal of the second derivative.
  double value(const JointVector& q, JointVector& gradient, JointVector& diagonal) const {
    return value(q, gradient, diagonal, nullptr);
  }
  /// Also the second derivative, if that is not null.
  double value(const JointVector& q, JointVector& gradient, JointVector& diagonal,
               SquareMatrix* second) const;

 private:
  /// What moves of the TCP do to the remainder: its derivative by a twist in base axes, and that of
  /// this in turn.
  struct AtPose {
    double value;
    Vector6 pull;
    Vector6 active;      ///< weights of what is not inside the task's bounds
    JacobianMatrix map;  ///< from twists to deviations
  };
  [[nodiscard]] AtPose at(const Pose& pose) const;
  [[nodiscard]] Matrix6 stiffness(const Pose& pose, const AtPose& at) const;

  /// Of several tips.
  double value_of_tips(const JointVector& q, JointVector* gradient, JointVector* diagonal) const;

  const Goal& goal_;
  const ChainModel& model_;
  Vector6 weights2_;
  bool is_simple_;
  bool turns_alike_;  ///< rotations about all axes weigh the same
};

}  // namespace iksel
