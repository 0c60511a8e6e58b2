// SPDX-License-Identifier: BSD-3-Clause
#include "refine/iterate.hpp"

#include <cmath>

#include "base/angle.hpp"
#include "base/rotation.hpp"
#include "iksel/pose.hpp"
#include "refine/limited_step.hpp"
#include "refine/schemes.hpp"

namespace iksel {
namespace {

/// Shortens the two halves of an error to the clamps.
void clamp_error(Vector6& e, double position, double rotation, const Paper& scheme) {
  if (position > scheme.position_clamp) e.head<3>() *= scheme.position_clamp / position;
  if (rotation > scheme.rotation_clamp) e.tail<3>() *= scheme.rotation_clamp / rotation;
}

bool stops_on_small_step(Iteration iteration) {
  return iteration == Iteration::dls || iteration == Iteration::pinv ||
         iteration == Iteration::pinv_rr || iteration == Iteration::cwpi;
}

bool stops_on_growth(const Paper& scheme) {
  if (scheme.growth_stop != GrowthStop::by_scheme) return scheme.growth_stop == GrowthStop::on;
  return scheme.iteration != Iteration::cwpi && stops_on_small_step(scheme.iteration);
}

/// What follows a step besides adding it.
void after_step(const IterationContext& context, JointVector& q) {
  if (context.scheme.iteration == Iteration::pinv_rr && !context.model.joints.contains(q.data())) {
    q = context.model.joints.sample(context.random);
  } else if (context.scheme.iteration == Iteration::cwln) {
    for (int i = 0; i < context.model.dof; ++i) {
      if (!context.model.joints.is_slide(i)) {
        q[i] = without_turns(q[i]);
      }
    }
  }
}

/// Where an attempt stands.
struct Standing {
  Goal::Linear at;  ///< of a full pose only what is missing and its Jacobian
  double position, rotation;
  double tcp_position;  ///< the rotation is the same there
};

Standing evaluate(const IterationContext& context, const JointVector& q) {
  const Goal& goal = context.goal;
  const bool at_tcp = !goal.is_full_pose();
  Standing standing;
  Goal::Linear& at = standing.at;
  Pose pose;
  if (context.kdl != nullptr) {
    pose = context.kdl->fk(q);
    at.J = context.kdl->jacobian(q);
  } else {
    Jacobian J;
    pose = to_pose(context.model.fk_jacobian(q.data(), J, at_tcp));
    at.J = J;
  }
  if (goal.is_full_pose()) {
    at.missing = pose_error(context.tip_target, pose);
  } else {
    goal.linearize(pose, /*exact=*/true, at);
  }
  standing.position = standing.tcp_position = at.missing.head<3>().norm();
  standing.rotation = at.missing.tail<3>().norm();
  if (!at_tcp) {
    const Eigen::Vector3d tcp = pose * Eigen::Vector3d(context.model.tcp.translation());
    standing.tcp_position = (goal.target().translation() - tcp).norm();
  }
  return standing;
}

/// The joint adjustment from q, where what is missing stands clamped in `at`.
JointVector adjust(const IterationContext& context, const JointVector& q, const Goal::Linear& at) {
  const Paper& scheme = context.scheme;
  const double damping = scheme.damping * at.missing.squaredNorm();
  const auto step_by = [&](const JacobianMatrix& J, const Vector6& e) {
    switch (scheme.iteration) {
      case Iteration::dls:
      case Iteration::pinv:
      case Iteration::pinv_rr:
        return inverse_step(context.model, q, J, e, scheme);
      case Iteration::cwln:
        return cwln_step(context.model, q, J, e, scheme);
      case Iteration::cwpi:
        return cwpi_step(context.model, q, J, e, scheme);
      case Iteration::lm:
        break;
    }
    return lm_step(context.model.joints, context.model.unit, q, J, e, damping, scheme.whole_turns);
  };
  return context.goal.is_full_pose() ? step_by(at.J, at.missing) : step_into_bounds(at, step_by);
}

}  // namespace

Outcome iterate(const IterationContext& context, JointVector& q, int& steps) {
  const ChainModel& model = context.model;
  const Paper& scheme = context.scheme;
  const TaskSpace& task = context.goal.task();
  const bool growth_stop = stops_on_growth(scheme);
  const bool small_step_stop = stops_on_small_step(scheme.iteration);
  Outcome outcome = Outcome::failed;
  double last_position = kInfinity;
  double last_rotation = kInfinity;

  for (int step = 0;; ++step) {
    Standing now = evaluate(context, q);
    if (now.tcp_position < task.position_tolerance() && now.rotation < task.rotation_tolerance()) {
      if (scheme.whole_turns) model.joints.wrap(q.data());
      if (model.joints.contains(q.data())) return Outcome::solved;
      outcome = Outcome::outside_limits;
      // Only the paper's first schemes go on from here; the others have nothing left to gain.
      if (scheme.limits_stop || !small_step_stop) return outcome;
    }
    if (growth_stop && now.position > last_position && now.rotation > last_rotation) return outcome;
    last_position = now.position;
    last_rotation = now.rotation;
    if (step == context.max_iterations) return outcome;

    if (scheme.iteration == Iteration::lm) {
      now.at.to_unit(model.unit);
    } else {
      clamp_error(now.at.missing, now.position, now.rotation, scheme);
    }
    const JointVector adjustment = adjust(context, q, now.at);
    ++steps;
    if (!adjustment.allFinite()) return outcome;
    if (small_step_stop && std::abs(adjustment.sum()) < scheme.min_step) {
      if (scheme.iteration != Iteration::pinv_rr) return outcome;
      q = model.joints.sample(context.random);
      continue;
    }
    q += adjustment;
    after_step(context, q);
  }
}

}  // namespace iksel
