// SPDX-License-Identifier: BSD-3-Clause
#include "refine/iterate.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "base/rotation.hpp"
#include "iksel/pose.hpp"
#include "refine/schemes.hpp"

namespace iksel {
namespace {

/// Shortens the two halves of an error to the clamps.
void clamp_error(Vector6& e, double position, double rotation, const Paper& scheme) {
  if (position > scheme.position_clamp) e.head<3>() *= scheme.position_clamp / position;
  if (rotation > scheme.rotation_clamp) e.tail<3>() *= scheme.rotation_clamp / rotation;
}

bool stops_on_growth(const Paper& scheme) {
  if (scheme.growth_stop != GrowthStop::by_scheme) return scheme.growth_stop == GrowthStop::on;
  return scheme.iteration == Iteration::dls || scheme.iteration == Iteration::pinv ||
         scheme.iteration == Iteration::pinv_rr;
}

bool stops_on_small_step(Iteration iteration) {
  return iteration == Iteration::dls || iteration == Iteration::pinv ||
         iteration == Iteration::pinv_rr || iteration == Iteration::cwpi;
}

/// `squared_error` is what lm damps by.
JointVector make_step(const IterationContext& context, const JointVector& q,
                      const JacobianMatrix& J, const Vector6& e, double squared_error) {
  const Paper& scheme = context.scheme;
  switch (scheme.iteration) {
    case Iteration::dls:
      return dls_step(J, e, scheme);
    case Iteration::pinv:
    case Iteration::pinv_rr:
      return pinv_step(J, e, scheme);
    case Iteration::cwln:
      return cwln_step(context.model, q, J, e, scheme);
    case Iteration::cwpi:
      return cwpi_step(context.model, q, J, e, scheme);
    case Iteration::lm:
      break;
  }
  return lm_step(context.model, q, J, e, scheme.damping * squared_error, scheme.whole_turns);
}

/// What follows a step besides adding it.
void after_step(const IterationContext& context, JointVector& q) {
  if (context.scheme.iteration == Iteration::pinv_rr && !context.model.joints.contains(q.data())) {
    context.model.joints.sample(context.random, q);
  } else if (context.scheme.iteration == Iteration::cwln) {
    for (int i = 0; i < context.model.dof; ++i) {
      if (!context.model.joints.is_slide(i)) {
        q[i] = without_turns(q[i]);
      }
    }
  }
}

/// A step that brings the deviation d (its Jacobian J, its error e) into the box, made by
/// `step(rows, asked, squared_error)`. Parts inside the box ask for nothing, unless the step would
/// take them out of it: then they are to stay at the bound.
template <typename Step>
JointVector task_step(const TaskSpace& task, const JacobianMatrix& J, const Vector6& d,
                      const Vector6& e, const Step& step) {
  const Vector6& lower = task.aim_lower();
  const Vector6& upper = task.aim_upper();
  const double squared_error = e.squaredNorm();
  Vector6 asked = e;
  JacobianMatrix rows = J;
  bool active[6];
  for (int i = 0; i < 6; ++i) {
    active[i] = e[i] != 0 || lower[i] == upper[i];
    if (!active[i]) rows.row(i).setZero();
  }
  for (int round = 0;; ++round) {
    JointVector adjustment = step(rows, asked, squared_error);
    constexpr int kRounds = 3;
    if (round == kRounds) return adjustment;
    bool changed = false;
    for (int i = 0; i < 6; ++i) {
      if (active[i]) continue;
      const double goal = d[i] + J.row(i).dot(adjustment);
      if (goal >= lower[i] && goal <= upper[i]) continue;
      active[i] = true;
      changed = true;
      rows.row(i) = J.row(i);
      asked[i] = (goal < lower[i] ? lower[i] : upper[i]) - d[i];
    }
    if (!changed) return adjustment;
  }
}

/// Where an attempt stands.
struct Standing {
  JacobianMatrix J;  ///< of the error's parts
  Vector6 d;         ///< deviation, for a task only
  Vector6 e;         ///< what is missing
  double position, rotation;
  double tcp_position;  ///< the rotation is the same there
};

Standing evaluate(const IterationContext& context, const JointVector& q) {
  const ChainModel& model = context.model;
  const Goal& goal = context.goal;
  const bool at_tcp = !goal.is_full_pose() || context.steps_at_tcp;
  Standing at;
  Pose pose;
  if (context.kdl != nullptr) {
    pose = context.kdl->fk(q);
    at.J = context.kdl->jacobian(q);
  } else {
    Jacobian J;
    model.fk_jacobian(q.data(), pose, J, at_tcp);
    at.J = J;
  }
  if (goal.is_full_pose()) {
    at.e = pose_error(context.tip_target, pose);
  } else {
    at.d = goal.task().deviation(goal.target(), pose, at.J);
    at.e = goal.task().missing(at.d);
  }
  at.position = at.tcp_position = at.e.head<3>().norm();
  at.rotation = at.e.tail<3>().norm();
  if (!at_tcp) {
    const Eigen::Vector3d tcp = pose * Eigen::Vector3d(model.tcp.translation());
    at.tcp_position = (goal.target().translation() - tcp).norm();
  }
  return at;
}

/// The joint adjustment from q, whose error stands clamped in `at`.
JointVector adjust(const IterationContext& context, const JointVector& q, const Standing& at) {
  const auto step_by = [&](const JacobianMatrix& rows, const Vector6& asked, double squared) {
    return make_step(context, q, rows, asked, squared);
  };
  if (context.goal.is_full_pose()) return step_by(at.J, at.e, at.e.squaredNorm());
  return task_step(context.goal.task(), at.J, at.d, at.e, step_by);
}

}  // namespace

Outcome iterate(const IterationContext& context, JointVector& q, int& steps) {
  /// Squared error that counts as far off [mixed units].
  constexpr double kFarOff2 = 1e-4;
  const ChainModel& model = context.model;
  const Paper& scheme = context.scheme;
  const TaskSpace& task = context.goal.task();
  const bool growth_stop = stops_on_growth(scheme);
  const bool small_step_stop = stops_on_small_step(scheme.iteration);
  Outcome outcome = Outcome::failed;
  double last_position = kInfinity;
  double last_rotation = kInfinity;

  for (int step = 0;; ++step) {
    Standing at = evaluate(context, q);
    const double part = step == context.max_iterations ? 1 : context.aim;
    if (at.tcp_position < part * task.position_tolerance() &&
        at.rotation < part * task.rotation_tolerance()) {
      if (scheme.whole_turns) model.joints.wrap(q.data());
      if (model.joints.contains(q.data())) return Outcome::solved;
      outcome = Outcome::outside_limits;
      // Only the paper's first schemes go on from here; the others have nothing left to gain.
      if (!stops_on_small_step(scheme.iteration)) return outcome;
    }
    if (growth_stop && at.position > last_position && at.rotation > last_rotation) return outcome;
    last_position = at.position;
    last_rotation = at.rotation;
    if (step == context.max_iterations) return outcome;
    if (step >= context.patience && at.e.squaredNorm() > kFarOff2) return outcome;

    if (scheme.iteration != Iteration::lm) clamp_error(at.e, at.position, at.rotation, scheme);
    const JointVector adjustment = adjust(context, q, at);
    ++steps;
    if (!adjustment.allFinite()) return outcome;
    if (small_step_stop && std::abs(adjustment.sum()) < scheme.min_step) {
      if (scheme.iteration != Iteration::pinv_rr) return outcome;
      model.joints.sample(context.random, q);
      continue;
    }
    q += adjustment;
    after_step(context, q);
  }
}

}  // namespace iksel
