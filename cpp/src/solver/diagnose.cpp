// SPDX-License-Identifier: BSD-3-Clause
// Why not: by all branches, or by questions with more work and fewer demands, one after the other.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "base/pseudo_inverse.hpp"
#include "options/strategy.hpp"
#include "refine/best_effort.hpp"
#include "solver/diagnose_branches.hpp"
#include "solver/diagnose_refusals.hpp"
#include "solver/limit_violations.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {
namespace {

/// With the work that a diagnosis may spend where a solve gave up.
SolverOptions generous(SolverOptions options) {
  Lanes lanes;
  lanes.neighbours = neighbours_of(options.strategy);
  options.strategy = lanes;
  options.max_attempts = std::max(options.max_attempts, 512);
  options.max_iterations = std::max(options.max_iterations, 200);
  return options;
}

/// The position's part of a task.
Task position_of(Task task) {
  const Task position = Task::position_only();
  task.rotation_lower = position.rotation_lower;
  task.rotation_upper = position.rotation_upper;
  return task;
}

/// The possible causes, one after the other; each check returns whether it was the reason.
class Diagnoser {
 public:
  Diagnoser(const Solver::Impl& solver, const Pose& target, const SolveRequest& request)
      : solver_(solver),
        model_(solver.robot.model()),
        task_(solver.task_of(request)),
        position_task_(position_of(task_.task()), solver.options.position_tolerance,
                       solver.options.rotation_tolerance),
        goal_(model_, task_, target),
        position_goal_(model_, position_task_, target),
        request_(request),
        open_(opened(request)) {}

  /// Whether all branches are known, of which none is an answer.
  bool explain_by_branches(Workspace& workspace) {
    if (!workspace.lanes) return false;
    Enumeration* branches = workspace.lanes->branches_of(task_);
    if (branches == nullptr) return false;
    // Of a completed chain, what is missing may be of a joint that there is not; nor are those of
    // an arm that is but nearly regular its own.
    if (branches->chain().is_completed() || !branches->are_answers()) return false;
    const Pose Y = workspace.lanes->query.reduce(goal_.target());
    BestEffort effort = make_effort(goal_);
    if (!explain_branches(goal_, Y, *branches, effort, out_)) return false;
    describe(effort.q());
    return true;
  }

  /// Whether more work or more time finds an answer.
  bool find_with_more_work(Status plain) {
    SolveRequest patient_request = request_;
    patient_request.deadline = kInfinity;
    patient_request.database_seeds = true;
    const Result found = patient().solve(goal_.target(), patient_request);
    out_.attempts += found.attempts;
    if (is_refusal(found.status)) {
      explain_refusals(found.status);
      return true;
    }
    if (!found.success()) return false;
    const bool singular = describe(found.q);
    out_.q_is_solution = true;
    if (plain == Status::out_of_time) {
      say(Cause::out_of_time,
          "an answer exists, but the deadline passed before it was found: allow more time");
    } else if (singular) {
      say(Cause::singular,
          "an answer exists close to a singularity (least singular value " +
              number_text(out_.least_singular_value, 3) +
              "), where iterations are slow: raise max_iterations, or loosen the tolerances");
    } else {
      say(Cause::budget,
          "an answer exists that the bounds on work were too low to find: raise max_attempts or "
          "max_iterations");
    }
    return true;
  }

  /// Whether there are answers outside the limits.
  bool find_outside_limits() {
    const Solver unlimited = make_patient(solver_.robot.without_limits());
    // The answers that violate the limits least are close to what does best inside them.
    BestEffort effort = make_effort(goal_);
    SolveRequest hinted = open_;
    for (JointVector& seed : effort.from_anywhere(kEfforts, solver_.options.seed)) {
      if (solver_.angles.holds(seed)) hinted.seeds.push_back(std::move(seed));
    }
    const Solutions answers = unlimited.solve_all(goal_.target(), {}, hinted);
    out_.attempts += answers.attempts;
    double least = kInfinity;
    for (const Result& answer : answers.all) {
      JointVector branch = model_.joints.turned_to_middle(answer.q);
      model_.joints.wrap_sums(branch.data());
      effort.from(branch);
      if (is_answer(model_.joints.clamp(branch))) return true;
      const double violation = worst_violation(model_.joints, branch);
      if (violation >= least) continue;
      least = violation;
      out_.branch = branch;
    }
    if (least == kInfinity) return false;
    if (is_answer(effort.q())) return true;
    set_violation(model_.joints, out_.branch, out_);
    describe(effort.q());
    say(Cause::joint_limits,
        "answers exist only outside the limits: " + describe_violation(model_, out_) +
            " or more; move the target, or leave an axis free");
    return true;
  }

  /// Whether the position can be reached with another rotation.
  bool find_position() {
    SolveRequest at_position = open_;
    at_position.task = position_task_.task();
    const Result position = patient().solve(goal_.target(), at_position);
    out_.attempts += position.attempts;
    if (!position.success()) return false;
    // From many configurations that have the position towards the rotation, the position weighing
    // more; then all the way back to the position.
    BestEffort effort = make_effort(goal_, /*part=*/0.01);
    SolveAllOptions spread_out;
    spread_out.max = kEfforts;
    spread_out.min_distance = 0.1;
    const Solutions spread = patient().solve_all(goal_.target(), spread_out, at_position);
    out_.attempts += spread.attempts;
    for (const Result& answer : spread.all) effort.from(answer.q);
    effort.from(position.q);
    effort.from_anywhere(kEfforts, solver_.options.seed);
    at_position.seeds = {effort.q()};
    at_position.near = effort.q();
    const Result held = patient().solve(goal_.target(), at_position);
    out_.attempts += held.attempts;
    describe(held.success() ? held.q : position.q);
    out_.rotation_gap = out_.rotation_error;
    say(Cause::orientation,
        "the position can be reached, but not with this rotation, which is off by " +
            number_text(out_.rotation_gap, kShownDigits) + " rad or more: " +
            (model_.dof < task_.constrained_axes() ? task_hint(solver_.robot, task_.task())
                                                   : "turn the target, or leave an axis free"));
    return true;
  }

  /// What is left: the position is too far away.
  void measure_distance(Status plain) {
    BestEffort nearest = make_effort(position_goal_);
    nearest.from_anywhere(2 * kEfforts, solver_.options.seed);
    double ignored = 0;
    position_goal_.measure(nearest.q(), out_.beyond_reach, ignored);
    BestEffort effort = make_effort(goal_);
    effort.from(nearest.q());
    effort.from_anywhere(kEfforts, solver_.options.seed);
    describe(effort.q());
    say(Cause::out_of_reach, "the position lies " + number_text(out_.beyond_reach, kShownDigits) +
                                 " m beyond what the arm reaches" +
                                 (plain == Status::out_of_reach ? "" : " within its limits") +
                                 ": move the target or the base, or allow a tolerance");
  }

  /// Where there is nothing to explain.
  [[nodiscard]] const Diagnosis& of_answer(const Result& plain) {
    describe(plain.q);
    out_.q_is_solution = true;
    out_.message = "solved";
    return diagnosis(plain.proof);
  }
  /// With what the plain solve has proven.
  [[nodiscard]] const Diagnosis& diagnosis(Proof proof) {
    out_.proof = out_.q_is_solution ? Proof::answer : proof;
    return out_;
  }

 private:
  Solver& patient() {
    if (!patient_) patient_.emplace(make_patient(solver_.robot));
    return *patient_;
  }
  /// A solver that works harder. The nominal chain is the one that it was accepted for.
  [[nodiscard]] Solver make_patient(const Robot& arm) const {
    return Solver(arm, generous(solver_.options), solver_.data(), solver_.nominal,
                  CalibrationDeviation{kInfinity, kInfinity});
  }
  /// A rotation counts that part of what it counts otherwise.
  [[nodiscard]] BestEffort make_effort(const Goal& towards, double part = 1) const {
    return {towards, part * solver_.data().data().weight};
  }

  void explain_refusals(Status status) {
    const auto find_all = [&](const SolveAllOptions& every, const SolveRequest& open) {
      Solutions found = patient().solve_all(goal_.target(), every, open);
      out_.attempts += found.attempts;
      return found;
    };
    const JointVector q = iksel::explain_refusals(request_, status, find_all, out_);
    if (q.size() > 0) describe(q);
  }

  void say(Cause cause, const std::string& message) {
    out_.cause = cause;
    out_.message = message;
  }

  /// Puts q into the diagnosis; true if it is close to a singularity.
  bool describe(const JointVector& q) {
    out_.q = q;
    goal_.measure(q, out_.position_error, out_.rotation_error);
    Jacobian J;
    model_.fk_jacobian(q.data(), J);
    const auto sigma = singular_values(JacobianMatrix(J));
    out_.least_singular_value = sigma.minCoeff();
    return out_.least_singular_value < 1e-3 * sigma.maxCoeff();
  }

  /// Whether q is an answer that the search has missed; it is then what is said.
  bool is_answer(const JointVector& q) {
    if (!goal_.is_solution(q)) return false;
    describe(q);
    out_.branch = JointVector();
    out_.q_is_solution = true;
    say(Cause::budget,
        "an answer exists that the search has missed: give it as a seed, or as `near`");
    return true;
  }

  const Solver::Impl& solver_;
  const ChainModel& model_;
  TaskSpace task_;
  TaskSpace position_task_;
  Goal goal_;
  Goal position_goal_;
  const SolveRequest& request_;
  /// The request without what refuses answers or prefers some.
  SolveRequest open_;
  std::optional<Solver> patient_;
  Diagnosis out_;
};

}  // namespace

Diagnosis Solver::Impl::diagnose(const Pose& target, const SolveRequest& request) const {
  const WorkspacePool::Lease lease(workspaces);
  SolveRequest proving = request;
  proving.prove = true;
  const Result plain = solve(&target, proving, lease.get(), nullptr);
  Diagnoser diagnoser(*this, target, request);
  if (plain.success()) return diagnoser.of_answer(plain);
  bool is_explained = plain.proof == Proof::closed_form && !is_refusal(plain.status) &&
                      diagnoser.explain_by_branches(lease.get());
  if (!is_explained && plain.status != Status::out_of_reach) {
    is_explained = diagnoser.find_with_more_work(plain.status) || diagnoser.find_outside_limits();
  }
  if (!is_explained && !diagnoser.find_position()) diagnoser.measure_distance(plain.status);
  return diagnoser.diagnosis(plain.proof);
}

}  // namespace iksel
