// SPDX-License-Identifier: BSD-3-Clause
// Why not: questions asked one after the other with more work and fewer demands.
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "error_check.hpp"
#include "iteration/task_step.hpp"
#include "math/constants.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// Work that a diagnosis may spend where a solve gave up.
constexpr int kPatientAttempts = 512;
constexpr int kPatientIterations = 200;

/// Singular values below this part of the largest are close to a singularity.
constexpr double kNearlySingular = 1e-3;

std::string format(const char* pattern, double value) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

SolverOptions generous(SolverOptions options) {
  options.iteration = Iteration::lm;
  options.damping = SolverOptions{}.damping;
  options.whole_turns = true;
  options.max_attempts = std::max(options.max_attempts, kPatientAttempts);
  options.max_iterations = std::max(options.max_iterations, kPatientIterations);
  return options;
}

/// The position's part of a task.
Task position_of(Task task) {
  for (std::size_t i = 0; i < 3; ++i) {
    task.rotation_lower[i] = -kNoBound;
    task.rotation_upper[i] = kNoBound;
  }
  return task;
}

/// Smallest and largest singular value of the Jacobian.
std::pair<double, double> singular_values(const ChainModel& model, const JointVector& q) {
  Pose pose;
  Jacobian J;
  model.fk_jacobian(q.data(), pose, J);
  const Eigen::JacobiSVD<JacobianMatrix> svd{JacobianMatrix(J)};
  return {svd.singularValues().minCoeff(), svd.singularValues().maxCoeff()};
}

/// How far each joint lies outside its limits, at the nearest turn.
JointVector violations(const ChainModel& model, JointVector q) {
  model.wrap_into_limits(q.data());
  JointVector outside = JointVector::Zero(model.dof);
  for (int j = 0; j < model.dof; ++j) {
    const auto beyond = [&](double at) {
      return std::max({model.lower[j] - at, at - model.upper[j], 0.0});
    };
    outside[j] = beyond(q[j]);
    if (model.joint_types[static_cast<std::size_t>(j)] == JointType::prismatic) continue;
    for (const double turn : {-kTwoPi, kTwoPi}) {
      outside[j] = std::min(outside[j], beyond(q[j] + turn));
    }
  }
  return outside;
}

/// Lowers the errors outside of the box from q on, inside the limits, by damped steps of which only
/// those are taken that help. `weight` is the length that 1 rad counts [m]. Returns the error [m].
double descend(const ChainModel& model, const SolverOptions& options, const TaskSpace& task,
               const Pose& target, double weight, JointVector& q) {
  Vector6 scale;
  scale << 1, 1, 1, weight, weight, weight;
  const auto error_of = [&](const JointVector& at) {
    return scale.cwiseProduct(task.outside(task.deviation(target, model.fk(at.data())))).norm();
  };
  q = q.cwiseMax(model.lower).cwiseMin(model.upper);
  double error = error_of(q);
  double damping = 1e-3;
  for (int i = 0; i < kPatientIterations && damping < 1e6 && error > 1e-12; ++i) {
    Pose pose;
    Jacobian of_pose;
    model.fk_jacobian(q.data(), pose, of_pose);
    JacobianMatrix J = of_pose;
    const Vector6 e = -task.outside(task.deviation(target, pose, J));
    for (int k = 0; k < 6; ++k) {
      if (e[k] == 0 && task.lower()[k] != task.upper()[k]) J.row(k).setZero();
    }
    SolverOptions damped = options;
    damped.damping = damping;
    const JacobianMatrix weighted = scale.asDiagonal() * J;
    const Vector6 asked = scale.cwiseProduct(e);
    const JointVector next = (q + lm_step(model, q, weighted, asked, damped))
                                 .cwiseMax(model.lower)
                                 .cwiseMin(model.upper);
    const double next_error = error_of(next);
    if (next_error < error) {
      const bool settled = error - next_error < 1e-9 * error;
      q = next;
      error = next_error;
      damping = std::max(damping / 5, 1e-6);
      if (settled) break;
    } else {
      damping *= 5;
    }
  }
  return error;
}

/// The least error found from many seeds, for a task without an answer.
class BestEffort {
 public:
  /// `weight` is the length that 1 rad counts [m].
  BestEffort(const ChainModel& model, const SolverOptions& options, double weight,
             const TaskSpace& task, const Pose& target)
      : model_(model), options_(options), task_(task), target_(target), weight_(weight) {}

  /// Makes 1 rad count that part of what it counts otherwise. To come first.
  void weigh_rotation(double part) { weight_ *= part; }

  /// Where it ended.
  JointVector from(const JointVector& seed) {
    JointVector q = seed;
    const double error = descend(model_, options_, task_, target_, weight_, q);
    if (error < error_) {
      error_ = error;
      q_ = q;
    }
    return q;
  }
  /// From n configurations spread over the limits.
  std::vector<JointVector> from_anywhere(int n) {
    Random random(options_.seed);
    JointVector q(model_.dof);
    std::vector<JointVector> ends;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < model_.dof; ++j) {
        q[j] = random.uniform(model_.sample_lower(j), model_.sample_upper(j));
      }
      ends.push_back(from(q));
    }
    return ends;
  }
  [[nodiscard]] const JointVector& q() const { return q_; }

 private:
  const ChainModel& model_;
  const SolverOptions& options_;
  const TaskSpace& task_;
  const Pose& target_;
  double weight_;
  double error_ = kNoBound;
  JointVector q_;
};

/// Seeds of a best effort.
constexpr int kEfforts = 24;

}  // namespace

const char* to_string(Cause cause) {
  switch (cause) {
    case Cause::none:
      return "none";
    case Cause::out_of_reach:
      return "out_of_reach";
    case Cause::orientation:
      return "orientation";
    case Cause::joint_limits:
      return "joint_limits";
    case Cause::rejected:
      return "rejected";
    case Cause::singular:
      return "singular";
    case Cause::budget:
      return "budget";
    case Cause::out_of_time:
      return "out_of_time";
  }
  return "unknown";
}

Diagnosis Solver::Impl::diagnose(const Pose& T_base_tip, const SolveRequest& request) const {
  const ChainModel& model = robot.model();
  const TaskSpace of_call = task_of(request);
  Diagnosis out;
  const auto describe = [&](const JointVector& q) {
    out.q = q;
    measure(of_call, T_base_tip, q, out.position_error, out.rotation_error);
    const auto [least, most] = singular_values(model, q);
    out.least_singular_value = least;
    return least < kNearlySingular * most;
  };

  const Lease lease(*this);
  const Result plain = solve(T_base_tip, request, lease.get());
  if (plain.success()) {
    describe(plain.q);
    out.q_is_solution = true;
    out.message = "solved";
    return out;
  }

  // The same question, with a chain, options and a request of its own.
  SolveRequest without_filter = request;
  without_filter.filter = nullptr;
  without_filter.near.reset();
  without_filter.deadline = kNoBound;
  without_filter.database_seeds = true;
  without_filter.objective = {};
  const double weight = database.data().weight;
  const auto make_patient = [&](const Robot& arm) {
    return Solver(arm, generous(options), database, nominal, Drift{kNoBound, kNoBound});
  };
  const Solver patient = make_patient(robot);
  const auto position_task = [&] {
    SolveRequest relaxed = without_filter;
    relaxed.task = position_of(of_call.task());
    return relaxed;
  };

  if (plain.status != Status::out_of_reach) {
    SolveRequest filtered = request;
    filtered.deadline = kNoBound;
    filtered.database_seeds = true;
    const Result found = patient.solve(T_base_tip, filtered);
    if (found.success()) {
      const bool singular = describe(found.q);
      out.q_is_solution = true;
      out.cause = plain.status == Status::out_of_time ? Cause::out_of_time
                  : singular                          ? Cause::singular
                                                      : Cause::budget;
      out.message =
          out.cause == Cause::out_of_time
              ? "an answer exists, but the deadline passed before it was found: allow more time"
          : singular ? format(
                           "an answer exists close to a singularity (least singular value "
                           "%.3g), where iterations are slow: raise max_iterations, or loosen "
                           "the tolerances",
                           out.least_singular_value)
                     : "an answer exists that the bounds on work were too low to find: raise "
                       "max_attempts or max_iterations";
      return out;
    }
    if (found.status == Status::rejected) {
      AllOptions all;
      all.max = kPatientAttempts;
      const Solutions refused = patient.solve_all(T_base_tip, all, without_filter);
      out.cause = Cause::rejected;
      out.refused = static_cast<int>(refused.all.size());
      if (!refused.all.empty()) describe(refused.all.front().q);
      out.message = "the filter refused each of " + std::to_string(out.refused) +
                    " answers: move the target, or let the filter pass more";
      return out;
    }

    const Solver free = make_patient(robot.without_limits());
    // The answers that violate the limits least are close to what does best inside them.
    BestEffort effort(model, options, weight, of_call, T_base_tip);
    SolveRequest hinted = without_filter;
    hinted.seeds = effort.from_anywhere(kEfforts);
    const Solutions unlimited = free.solve_all(T_base_tip, {}, hinted);
    for (const Result& answer : unlimited.all) {
      const JointVector outside = violations(model, answer.q);
      int joint = 0;
      const double violation = outside.maxCoeff(&joint);
      if (out.joint >= 0 && violation >= out.limit_violation) continue;
      out.joint = joint;
      out.limit_violation = violation;
      out.q = answer.q;
    }
    if (out.joint >= 0) {
      out.cause = Cause::joint_limits;
      for (const Result& answer : unlimited.all) {
        JointVector seed = answer.q;
        model.wrap_into_limits(seed.data());
        effort.from(seed);
      }
      describe(effort.q());
      const auto joint = static_cast<std::size_t>(out.joint);
      const bool slides = model.joint_types[joint] == JointType::prismatic;
      out.message = "answers exist only outside the limits: joint '" + model.joint_names[joint] +
                    "' would have to go beyond by " +
                    format(slides ? "%.4g m" : "%.4g rad", out.limit_violation) +
                    " at least; move the target, or leave an axis free";
      return out;
    }
  }

  BestEffort effort(model, options, weight, of_call, T_base_tip);
  const Result position = patient.solve(T_base_tip, position_task());
  if (position.success()) {
    // From many configurations that have the position towards the rotation, the position weighing
    // more; then all the way back to the position.
    constexpr double kLittle = 0.01;
    effort.weigh_rotation(kLittle);
    AllOptions all;
    all.max = kEfforts;
    all.min_distance = 0.1;
    SolveRequest at_position = position_task();
    for (const Result& answer : patient.solve_all(T_base_tip, all, at_position).all) {
      effort.from(answer.q);
    }
    effort.from(position.q);
    effort.from_anywhere(kEfforts);
    at_position.seeds = {effort.q()};
    at_position.near = effort.q();
    const Result held = patient.solve(T_base_tip, at_position);
    describe(held.success() ? held.q : position.q);
    out.cause = Cause::orientation;
    out.rotation_gap = out.rotation_error;
    out.message = format(
                      "the position can be reached, but not with this rotation: it is off by "
                      "%.4g rad at least; ",
                      out.rotation_gap) +
                  (model.dof < of_call.constrained_axes()
                       ? "the arm has fewer joints than the task has axes: leave an axis free"
                       : "turn the target, or leave an axis free");
    return out;
  }

  const TaskSpace of_position(position_of(of_call.task()), options.position_tolerance,
                              options.rotation_tolerance);
  BestEffort nearest(model, options, weight, of_position, T_base_tip);
  nearest.from_anywhere(2 * kEfforts);
  double ignored = 0;
  measure(of_position, T_base_tip, nearest.q(), out.beyond_reach, ignored);
  effort.from(nearest.q());
  effort.from_anywhere(kEfforts);
  describe(effort.q());
  out.cause = Cause::out_of_reach;
  out.message = format("the position lies %.4g m beyond what the arm reaches", out.beyond_reach) +
                (plain.status == Status::out_of_reach ? "" : " within its limits") +
                ": move the target or the base, or allow a tolerance";
  return out;
}

Diagnosis Solver::diagnose(const Pose& T_base_tip, const SolveRequest& request) const {
  check_pose(T_base_tip);
  request.validate(robot().dof());
  return impl_->diagnose(T_base_tip, request);
}

}  // namespace iksel
