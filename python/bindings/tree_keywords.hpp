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
class TreeFilter : public py::object {
  PYBIND11_OBJECT_DEFAULT(TreeFilter, object, is_any_object)
};

/// A Task for each tip.
class TaskList : public py::object {
  PYBIND11_OBJECT_DEFAULT(TaskList, object, is_any_object)
};

/// What solve and its like take besides poses.
struct TreeKeywords {
  std::optional<ArrayLike> weights;
  Loose<MoveNorm> norm;
  std::optional<TreeFilter> filter;
  std::optional<Loose<double>> deadline;
  std::optional<TaskList> tasks;
};

inline TreeRequest read_tree_request(const TreeSolver& self, const TreeKeywords& given) {
  const int dof = self.robot().dof();
  TreeRequest request;
  if (given.weights) request.weights = as_joints(*given.weights, dof, "weights");
  request.norm = from_python<MoveNorm>(given.norm, "norm");
  if (given.filter) request.filter = make_filter(*given.filter, "filter", dof);
  if (given.deadline) request.deadline = from_python<double>(*given.deadline, "deadline");
  if (given.tasks) {
    request.tasks = read_sequence(*given.tasks, "tasks", "a list of Tasks, one for each tip",
                                  from_python<Task>);
  }
  return request;
}

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::TreeFilter> {
  static constexpr auto name =
      const_name("collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], typing.Any]");
};
template <>
struct handle_type_name<iksel::python::TaskList> {
  static constexpr auto name =
      const_name("collections.abc.Sequence[Task | collections.abc.Mapping[str, object]]");
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)
