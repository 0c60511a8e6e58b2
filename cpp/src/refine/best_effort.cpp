// SPDX-License-Identifier: BSD-3-Clause
#include "refine/best_effort.hpp"

#include <algorithm>

#include "base/random.hpp"
#include "refine/schemes.hpp"
#include "refine/task_step.hpp"

namespace iksel {
namespace {

/// Steps of one descent at most.
constexpr int kDescentSteps = 200;

/// Lowers the errors outside of the box from q on, inside the limits, by damped steps of which only
/// those are taken that help. `weight` is the length that 1 rad counts [m]. Returns the error [m].
double descend(const ChainModel& model, const Goal& goal, double weight, JointVector& q) {
  const TaskSpace& task = goal.task();
  const Pose& target = goal.target();
  Vector6 scale;
  scale << 1, 1, 1, weight, weight, weight;
  const auto error_of = [&](const JointVector& at) {
    return scale.cwiseProduct(task.outside(task.deviation(target, model.fk(at.data())))).norm();
  };
  q = model.joints.clamp(q);
  double error = error_of(q);
  double damping = 1e-3;
  for (int i = 0; i < kDescentSteps && damping < 1e6 && error > 1e-12; ++i) {
    Pose pose;
    Jacobian of_pose;
    model.fk_jacobian(q.data(), pose, of_pose);
    JacobianMatrix J = of_pose;
    const Vector6 e = -task.outside(task.deviation(target, pose, J));
    for (int k = 0; k < 6; ++k) {
      if (e[k] == 0 && task.lower()[k] != task.upper()[k]) J.row(k).setZero();
    }
    const JacobianMatrix weighted = scale.asDiagonal() * J;
    const Vector6 asked = scale.cwiseProduct(e);
    const JointVector next =
        model.joints.clamp(q + lm_step(model, q, weighted, asked, damping * asked.squaredNorm()));
    const double next_error = error_of(next);
    if (next_error < error) {
      const bool converged = error - next_error < 1e-9 * error;
      q = next;
      error = next_error;
      damping = std::max(damping / 5, 1e-6);
      if (converged) break;
    } else {
      damping *= 5;
    }
  }
  // Steps may have turned a continuous joint many times; whole turns matter only to joints that
  // follow it.
  JointVector principal = q;
  model.joints.wrap(principal.data());
  if (error_of(principal) <= error + 1e-9 * (1 + error)) q = principal;
  return error;
}

}  // namespace

JointVector BestEffort::from(const JointVector& seed) {
  JointVector q = seed;
  const double error = descend(model_, goal_, weight_, q);
  if (error < error_) {
    error_ = error;
    q_ = q;
  }
  return q;
}

std::vector<JointVector> BestEffort::from_anywhere(int n, std::uint64_t seed) {
  Random random(seed);
  JointVector q(model_.dof);
  std::vector<JointVector> ends;
  for (int i = 0; i < n; ++i) {
    model_.joints.sample(random, q);
    ends.push_back(from(q));
  }
  return ends;
}

}  // namespace iksel
