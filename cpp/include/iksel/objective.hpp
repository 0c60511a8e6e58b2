// SPDX-License-Identifier: BSD-3-Clause
// What an answer is to be good at besides reaching the target.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "iksel/export.hpp"
#include "iksel/robot.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// A cost of joint values, the smaller the better. Among all answers found the cheapest is taken;
/// where the task leaves the arm free to move (more joints than fixed axes) the best are
/// first moved along their self-motion to a local minimum of the cost.
struct IKSEL_EXPORT Objective {
  enum class Kind {
    none,
    posture,         ///< 1/2 sum (w_i (q_i - posture_i))^2
    limits,          ///< sum 1/4 (1/x_i + 1/(1 - x_i)), x_i in 0 .. 1 the place between the limits
    manipulability,  ///< -sqrt(det(J J^T)) (Yoshikawa 1985); of J^T J with fewer than 6 joints
    custom,          ///< the caller's
  };

  /// What it counts.
  Kind kind = Kind::none;
  /// posture: where the joints are to be [rad or m], inside the limits or not, and the weight of
  /// each, >= 0; no weights: all 1.
  JointVector posture;
  JointVector weights;
  /// custom: the cost of q, which lies inside the limits, and its derivative; without one, central
  /// differences of the cost are taken. Called from the thread that solves. Their exceptions end
  /// the solve and reach the caller. A cost of +infinity refuses q, as a filter does; NaN and
  /// -infinity, and a gradient that is not finite, are an InvalidArgumentError that ends the solve.
  std::function<double(const JointVector& q)> cost;
  std::function<JointVector(const JointVector& q)> gradient;

  /// Near joint values [rad or m], inside the limits or not: 1/2 sum (w_i (q_i - posture_i))^2,
  /// weights >= 0, or all 1.
  [[nodiscard]] static Objective near_posture(const JointVector& posture,
                                              const JointVector& weights = {});
  /// Some joints, as a rail or a turntable, at a value where that is possible, else as near to it
  /// as may be: near_posture with weights of these joints only. Values by joint [rad or m], and
  /// weights, > 0, of those that are to have another than 1. Between answers that are equally good
  /// the request's `near` decides, or else the middle of the limits. Throws UnknownNameError naming
  /// a joint that the robot does not have, InvalidArgumentError a number that is no good.
  [[nodiscard]] static Objective preferred(const Robot& robot,
                                           const std::map<std::string, double>& values,
                                           const std::map<std::string, double>& weights = {});
  /// Far from the limits: sum 1/4 (1/x_i + 1/(1 - x_i)), x_i in 0 .. 1 the place between them, of
  /// joints and of coupled limits; joints without limits do not count (Zghal, Dubey and Euler
  /// 1990). Nearer to a limit than 1e-4 the sum goes on in a straight line.
  [[nodiscard]] static Objective far_from_limits();
  /// Far from singularities: -sqrt(det(J J^T)) (Yoshikawa 1985); of J^T J with fewer than 6 joints.
  [[nodiscard]] static Objective most_manipulable();
  /// What the caller says.
  [[nodiscard]] static Objective custom(
      std::function<double(const JointVector&)> cost,
      std::function<JointVector(const JointVector&)> gradient = {});

  [[nodiscard]] bool is_set() const { return kind != Kind::none; }
  /// Throws InvalidArgumentError naming the first field that does not fit a chain of `dof` joints.
  void validate(int dof) const;
};

}  // namespace iksel
