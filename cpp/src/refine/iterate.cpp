// SPDX-License-Identifier: BSD-3-Clause
#include "refine/iterate.hpp"

#include <cmath>
#include <limits>

#include "base/constants.hpp"
#include "base/rotation.hpp"
#include "refine/schemes.hpp"
#include "refine/task_step.hpp"

namespace iksel {
namespace {

/// [position; rotation vector] error of a pose against the target.
Vector6 error_vector(const Pose& target, const Pose& pose) {
  Vector6 e;
  e << target.translation() - pose.translation(),
      to_rotation_vector(target.linear() * pose.linear().transpose());
  return e;
}

/// Shortens the two halves of an error to the clamps.
void clamp_error(Vector6& e, double position, double rotation, const SolverOptions& options) {
  if (position > options.position_clamp) e.head<3>() *= options.position_clamp / position;
  if (rotation > options.rotation_clamp) e.tail<3>() *= options.rotation_clamp / rotation;
}

bool stops_on_growth(const SolverOptions& options) {
  if (options.growth_stop != GrowthStop::by_scheme) return options.growth_stop == GrowthStop::on;
  return options.iteration == Iteration::dls || options.iteration == Iteration::pinv;
}

bool stops_on_small_step(Iteration iteration) {
  return iteration == Iteration::dls || iteration == Iteration::pinv ||
         iteration == Iteration::pinv_rr;
}

/// `squared_error` is what lm damps by.
JointVector make_step(const IterationContext& context, const JointVector& q,
                      const JacobianMatrix& J, const Vector6& e, double squared_error) {
  const SolverOptions& options = context.options;
  switch (options.iteration) {
    case Iteration::dls:
      return dls_step(J, e, options);
    case Iteration::pinv:
    case Iteration::pinv_rr:
      return pinv_step(J, e, options);
    case Iteration::cwln:
      return cwln_step(context.model, q, J, e, options);
    case Iteration::cwpi:
      return cwpi_step(context.model, q, J, e, options);
    case Iteration::lm:
      break;
  }
  return lm_step(context.model, q, J, e, options, squared_error);
}

/// What follows a step besides adding it; true if the attempt goes on.
void after_step(const IterationContext& context, JointVector& q) {
  if (context.options.iteration == Iteration::pinv_rr && !context.model.joints.contains(q.data())) {
    context.model.joints.sample(context.random, q);
  } else if (context.options.iteration == Iteration::cwln) {
    for (int i = 0; i < context.model.dof; ++i) {
      if (!context.model.joints.is_slide(i)) {
        q[i] = std::remainder(q[i], kTwoPi);
      }
    }
  }
}

}  // namespace

void measure_error(const Pose& target, const Frame<double>& f, double& position_error,
                   double& rotation_error) {
  double square = 0;
  double sine2 = 0;  // |R_target R^T - its transpose|^2 / 4: sine of the angle, squared
  double trace = 0;
  for (int i = 0; i < 3; ++i) {
    const int a = (i + 1) % 3;
    const int b = (i + 2) % 3;
    const double d = target(i, 3) - f.p[i];
    const double v = 0.5 * (f.x[a] * target(b, 0) - f.x[b] * target(a, 0) + f.y[a] * target(b, 1) -
                            f.y[b] * target(a, 1) + f.z[a] * target(b, 2) - f.z[b] * target(a, 2));
    square += d * d;
    sine2 += v * v;
    trace += f.x[i] * target(i, 0) + f.y[i] * target(i, 1) + f.z[i] * target(i, 2);
  }
  const double sine = std::sqrt(sine2);
  position_error = std::sqrt(square);
  // asin by its series where that is exact to the last digit; it also spares an arc tangent.
  const bool small = sine < 1e-4 && trace > 1;
  rotation_error = small ? sine * (1 + sine2 / 6) : std::atan2(sine, 0.5 * (trace - 1));
}

Outcome iterate(const IterationContext& context, JointVector& q, int& steps) {
  const ChainModel& model = context.model;
  const SolverOptions& options = context.options;
  const bool growth_stop = stops_on_growth(options);
  const bool small_step_stop = stops_on_small_step(options.iteration);
  Outcome outcome = Outcome::failed;
  double last_position = std::numeric_limits<double>::infinity();
  double last_rotation = std::numeric_limits<double>::infinity();
  Pose pose;
  Jacobian J;
  const TaskSpace* task = context.task;

  for (int step = 0;; ++step) {
    if (context.kdl != nullptr) {
      pose = context.kdl->fk(q);
      J = context.kdl->jacobian(q);
    } else {
      model.fk_jacobian(q.data(), pose, J, task != nullptr);
    }
    JacobianMatrix rows = J;
    Vector6 d;
    Vector6 e;
    if (task == nullptr) {
      e = error_vector(context.tip_target, pose);
    } else {
      d = task->deviation(context.target, pose, rows);
      e = task_error(*task, d);
    }
    const double position = e.head<3>().norm();
    const double rotation = e.tail<3>().norm();  // the same at the TCP
    const double tcp_position =
        task != nullptr
            ? position
            : (context.target.translation() - pose * Eigen::Vector3d(model.tcp.translation()))
                  .norm();

    if (tcp_position < options.position_tolerance && rotation < options.rotation_tolerance) {
      if (options.whole_turns) model.joints.wrap(q.data());
      if (model.joints.contains(q.data())) return Outcome::solved;
      outcome = Outcome::outside_limits;
      // Only the paper's first two schemes go on from here; the others have nothing left to gain.
      if (options.iteration == Iteration::cwln || options.iteration == Iteration::cwpi ||
          options.iteration == Iteration::lm) {
        return outcome;
      }
    }
    if (growth_stop && position > last_position && rotation > last_rotation) return outcome;
    last_position = position;
    last_rotation = rotation;
    if (step == options.max_iterations) return outcome;
    /// Squared error that counts as far off [mixed units].
    constexpr double kStillFarOff2 = 1e-4;
    if (step >= context.patience && e.squaredNorm() > kStillFarOff2) return outcome;

    if (options.iteration != Iteration::lm) clamp_error(e, position, rotation, options);
    const auto step_by = [&](const JacobianMatrix& part, const Vector6& asked, double squared) {
      return make_step(context, q, part, asked, squared);
    };
    const JointVector adjustment =
        task != nullptr ? task_step(*task, rows, d, e, step_by) : step_by(rows, e, e.squaredNorm());
    ++steps;
    if (!adjustment.allFinite()) return outcome;
    if (small_step_stop && std::abs(adjustment.sum()) < options.min_step) {
      if (options.iteration != Iteration::pinv_rr) return outcome;
      model.joints.sample(context.random, q);
      continue;
    }
    q += adjustment;
    after_step(context, q);
  }
}

}  // namespace iksel
