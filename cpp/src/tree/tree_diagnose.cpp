// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include "base/message_text.hpp"
#include "tree/tree_solver_impl.hpp"

namespace iksel {
namespace {

/// What keeps tips that can be reached one by one from being reached together.
std::string together_text(const TreeModel& model) {
  if (model.shared.empty()) return "each tip can be reached, by joints of its own";
  std::vector<std::string> names;
  for (const int joint : model.shared) names.push_back(model.joints.name(joint));
  return "each tip can be reached by itself, but no values of the joints that they share (" +
         list_names(names) +
         ") were found at which all are; other poses, or a task that leaves "
         "one of them an axis, may do";
}

}  // namespace

TreeDiagnosis TreeSolver::diagnose(const std::vector<Pose>& T_base_tip,
                                   const TreeRequest& request) const {
  const std::vector<Pose> targets = impl_->check_targets(T_base_tip);
  impl_->check(request);
  TreeDiagnosis diagnosis;
  const std::vector<TaskSpace> tasks = impl_->tasks_of(request);
  for (int i = 0; i < robot().tips(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    SolveRequest alone;
    alone.task = tasks[k].task();
    const Diagnosis of_tip = impl_->solvers[k].chain.diagnose(targets[k], alone);
    if (diagnosis.unreachable_tip < 0 && of_tip.cause != Cause::none) {
      diagnosis.unreachable_tip = i;
      diagnosis.message = "tip '" + robot().tip_links()[k] + "' by itself: " + of_tip.message;
    }
    diagnosis.tips.push_back(of_tip);
  }
  if (diagnosis.unreachable_tip >= 0) return diagnosis;
  const TreeResult result = impl_->solve(targets, request);
  if (result.success()) {
    diagnosis.message = "there is an answer";
  } else if (result.status == Status::rejected) {
    diagnosis.message = "answers exist, but the filter refuses each that was found";
  } else if (result.status == Status::out_of_time) {
    diagnosis.message = "the deadline passed before an answer was found";
  } else {
    diagnosis.message = together_text(impl_->model());
  }
  return diagnosis;
}

}  // namespace iksel
