// SPDX-License-Identifier: BSD-3-Clause
// Angles so large that a double cannot tell their poses apart.
#include <algorithm>
#include <cmath>
#include <string>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {
double Solver::Impl::find_largest_angle() const {
  // FK turns joint k by m_k q_k + offset_k, of which rounding takes at most half a unit in the last
  // place: |m_k q_k| 2^-53. That turns the tip by as much, and moves it by its lever, which the
  // reach bounds, times as much. All joints together are to stay within a tenth of the tolerances.
  constexpr double kShare = 0.1;
  // Below, what is lost is lost at any angle.
  constexpr double kLeast = 100;
  double angles = 0;
  for (const KernelJoint& joint : robot.model().kernel.joints) {
    if (!joint.prismatic) angles += std::abs(joint.multiplier);
  }
  const double rotation = std::min(options.rotation_tolerance,
                                   options.position_tolerance / std::max(robot.reach(), 1e-300));
  return std::max(kLeast, kShare * rotation / (std::ldexp(1.0, -53) * std::max(angles, 1.0)));
}

int Solver::Impl::first_large_angle(const JointVector& q) const {
  for (int j = 0; j < robot.dof(); ++j) {
    if (!(std::abs(q[j]) <= largest_angle) && turns_a_joint(robot.model(), j)) return j;
  }
  return -1;
}

void Solver::Impl::check_angles(const JointVector& q, const char* name) const {
  const int j = first_large_angle(q);
  if (j < 0) return;
  const ChainModel& model = robot.model();
  const auto k = static_cast<std::size_t>(j);
  const bool slides = model.joints.types[k] == JointType::prismatic;
  throw InvalidArgumentError(
      std::string(name) + "[" + std::to_string(j) + "] (joint '" + model.joints.names[k] +
      "'): " + number_text(q[j]) + (slides ? " m, by which others turn" : " rad") +
      "; at angles beyond " + number_text(largest_angle) +
      " rad a double cannot tell poses of this robot apart to a tenth of the tolerances (" +
      number_text(options.position_tolerance) + " m, " + number_text(options.rotation_tolerance) +
      " rad): " + (slides ? "narrow its limits" : "take off whole turns"));
}

void Solver::Impl::check_limits() const {
  const ChainModel& model = robot.model();
  const auto finite = [](double limit) { return std::isfinite(limit) ? limit : 0.0; };
  check_angles(model.joints.lower.unaryExpr(finite), "lower limit");
  check_angles(model.joints.upper.unaryExpr(finite), "upper limit");
}

void Solver::Impl::check(const SolveRequest& request) const {
  request.validate(robot.dof());
  if (request.near) check_angles(*request.near, "near");
  if (request.objective.posture.size() != 0) check_angles(request.objective.posture, "posture");
  for (std::size_t i = 0; i < request.seeds.size(); ++i) {
    // There may be many: names are made for the error only.
    if (request.seeds[i].cwiseAbs().maxCoeff() <= largest_angle) continue;
    check_angles(request.seeds[i], ("seeds[" + std::to_string(i) + "]").c_str());
  }
}

}  // namespace iksel
