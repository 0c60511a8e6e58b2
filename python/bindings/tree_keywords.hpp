// SPDX-License-Identifier: BSD-3-Clause
// The keywords of TreeSolver's methods.
#pragma once

#include <optional>
#include <vector>

#include "array_checks.hpp"
#include "filter.hpp"
#include "iksel/tree_solver.hpp"
#include "option_fields.hpp"
#include "sequence_of.hpp"
#include "task_fields.hpp"

namespace iksel::python {

/// Called with candidates (n, dof); returns n truth values.
struct TreeFilter : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText =
      "collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any]";
};

/// A Task for each tip.
struct TaskList : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText =
      "collections.abc.Sequence[Task | collections.abc.Mapping[str, object]]";
};

/// What solve and its like take besides poses.
struct TreeKeywords {
  std::optional<ArrayLike> weights;
  MoveNorm norm = MoveNorm::two;
  std::optional<TreeFilter> filter;
  std::optional<double> deadline;
  std::optional<TaskList> tasks;
};

inline TreeRequest read_tree_request(const TreeSolver& self, const TreeKeywords& given) {
  const int dof = self.robot().dof();
  TreeRequest request;
  if (given.weights) request.weights = as_joints(*given.weights, dof, "weights");
  request.norm = given.norm;
  if (given.filter) request.filter = make_filter(*given.filter, "filter", dof);
  if (given.deadline) request.deadline = *given.deadline;
  if (given.tasks) {
    request.tasks = read_sequence(*given.tasks, "tasks", "a list of Tasks, one for each tip",
                                  from_python<Task>);
  }
  return request;
}

}  // namespace iksel::python
