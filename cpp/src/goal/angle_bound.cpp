// SPDX-License-Identifier: BSD-3-Clause
#include "goal/angle_bound.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "kinematics/tips_model.hpp"

namespace iksel {
namespace {

double find_largest(const ChainModel& model, const SolverOptions& options) {
  // FK turns joint k by m_k q_k + offset_k, of which rounding takes at most half a unit in the last
  // place: |m_k q_k| 2^-53. That rotates the TCP by as much, and moves it by its lever, which the
  // reach bounds, times as much. All joints together are to stay within a tenth of the tolerances.
  constexpr double kShare = 0.1;
  // Below, what is lost is lost at any angle.
  constexpr double kLeast = 100;
  double angles = 0;
  for (const KernelJoint& joint : model.kernel.joints) {
    const double steepest = joint.curve ? joint.curve->steepest() : 1;
    if (!joint.prismatic) angles += std::abs(joint.multiplier) * steepest;
  }
  const double rotation =
      std::min(options.rotation_tolerance,
               options.position_tolerance / std::max(model.reach_of_tcp(), 1e-300));
  return std::max(kLeast, kShare * rotation / (std::ldexp(1.0, -53) * std::max(angles, 1.0)));
}

}  // namespace

AngleBound::AngleBound(const Robot& robot, const SolverOptions& options)
    : joints_(robot.all().joints),
      position_tolerance_(options.position_tolerance),
      rotation_tolerance_(options.rotation_tolerance),
      largest_(JointVector::Constant(robot.dof(), kInfinity)) {
  for (int tip = 0; tip < robot.tips(); ++tip) {
    const ChainModel& chain = robot.chain(tip).model();
    const double largest = find_largest(chain, options);
    for (int j = 0; j < chain.dof; ++j) {
      double& of_joint = largest_[robot.joints_of(tip)[static_cast<std::size_t>(j)]];
      const bool turns =
          chain.moves_any(j, [](const KernelJoint& joint) { return !joint.prismatic; });
      if (turns) of_joint = std::min(of_joint, largest);
    }
  }
  const auto finite = [](double limit) { return std::isfinite(limit) ? limit : 0.0; };
  check(joints_.lower.unaryExpr(finite), "lower limit");
  check(joints_.upper.unaryExpr(finite), "upper limit");
}

int AngleBound::first_beyond(const JointVector& q) const {
  for (int j = 0; j < joints_.dof(); ++j) {
    if (!(std::abs(q[j]) <= largest_[j])) return j;
  }
  return -1;
}

void AngleBound::check(const JointVector& q, const char* name) const {
  const int j = first_beyond(q);
  if (j < 0) return;
  const bool slides = joints_.is_slide(j);
  throw InvalidArgumentError(
      std::string(name) + "[" + std::to_string(j) + "] (joint '" + joints_.name(j) +
      "'): " + number_text(q[j]) + (slides ? " m, by which others turn" : " rad") +
      "; at angles beyond " + number_text(largest_[j]) +
      " rad a double cannot tell poses of this robot apart to a tenth of the tolerances (" +
      number_text(position_tolerance_) + " m, " + number_text(rotation_tolerance_) +
      " rad): " + (slides ? "narrow its limits" : "take off whole turns"));
}

void AngleBound::check(const SolveRequest& request) const {
  if (request.near) check(*request.near, "near");
  if (request.objective.posture.size() != 0) check(request.objective.posture, "posture");
  for (std::size_t i = 0; i < request.seeds.size(); ++i) {
    // There may be many: names are made for the error only.
    if (holds(request.seeds[i])) continue;
    check(request.seeds[i], ("seeds[" + std::to_string(i) + "]").c_str());
  }
}

}  // namespace iksel
