// SPDX-License-Identifier: BSD-3-Clause
// Why not, of several tips: one that cannot be reached by itself, what refuses the answers, or the
// joints that they share.
#include <string>
#include <vector>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "refine/best_effort.hpp"
#include "solver/diagnose_refusals.hpp"
#include "solver/solver_impl.hpp"
#include "solver/tips_search.hpp"

namespace iksel {
namespace {

/// What keeps tips that can be reached one by one from being reached together.
std::string together_text(const RobotModel& model) {
  if (model.shared.empty()) {
    return "each tip can be reached by itself, but no answer was found in which all are: give "
           "seeds, "
           "or leave one of them an axis free";
  }
  std::vector<std::string> names;
  for (const int joint : model.shared) names.push_back(model.joints.name(joint));
  return "each tip can be reached by itself, but no values of the joints that they share (" +
         list_names(names) +
         ") were found at which all are: other poses may do, or a task that leaves one of them an "
         "axis free";
}

}  // namespace

Diagnosis Solver::Impl::diagnose_tips(const std::vector<Pose>& targets,
                                      const SolveRequest& request) const {
  const std::vector<TaskSpace> tasks = tasks_of(request);
  for (int i = 0; i < robot.tips(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    // Where that is depends on another.
    if (!request.in_frame_of.empty() && request.in_frame_of[k] >= 0) continue;
    SolveRequest alone;
    alone.task = tasks[k].task();
    Diagnosis of_tip = tips->chain(i).diagnose(targets[k], alone);
    if (of_tip.cause == Cause::none) continue;
    of_tip.unreachable_tip = i;
    of_tip.message = "tip '" + robot.tip_links()[k] + "' by itself: " + of_tip.message;
    return of_tip;
  }
  const WorkspacePool::Lease lease(workspaces);
  Workspace& workspace = lease.get();
  const Result result = solve(targets.data(), request, workspace, nullptr);
  return with_goal(targets.data(), request, nullptr, [&](const Goal& goal) {
    Diagnosis out;
    out.attempts = result.attempts;
    out.proof = result.proof;
    out.q = result.q;
    if (result.success()) {
      out.message = "solved";
      out.q_is_solution = true;
    } else if (is_refusal(result.status)) {
      const auto find_all = [&](const SolveAllOptions& every, const SolveRequest& open) {
        return solve_all(goal, every, open, workspace);
      };
      out.q = explain_refusals(request, result.status, find_all, out);
    } else {
      BestEffort effort(goal, rotation_weight());
      effort.from_anywhere(kEfforts, options.seed);
      out.q = effort.q();
      const bool is_late = result.status == Status::out_of_time;
      out.cause = is_late ? Cause::out_of_time : Cause::shared_joints;
      out.message = is_late ? "the deadline passed before an answer was found: allow more time"
                            : together_text(robot.all());
    }
    if (out.q.size() > 0) goal.measure(out.q, out.position_error, out.rotation_error);
    return out;
  });
}

Diagnosis Solver::diagnose(const Pose& T_base_tip, const SolveRequest& request) const {
  return diagnose(std::vector<Pose>{T_base_tip}, request);
}

Diagnosis Solver::diagnose(const std::vector<Pose>& T_base_tip, const SolveRequest& request) const {
  const std::vector<Pose> targets = impl_->check_targets(T_base_tip);
  impl_->check(request);
  if (request.closest) throw InvalidArgumentError("closest: diagnose gives it anyway, as q");
  return impl_->tips ? impl_->diagnose_tips(targets, request)
                     : impl_->diagnose(targets.front(), request);
}

}  // namespace iksel
