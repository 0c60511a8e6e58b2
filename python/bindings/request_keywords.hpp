// SPDX-License-Identifier: BSD-3-Clause
// What the keywords of Solver's methods take.
#pragma once

#include <optional>
#include <vector>

#include "array_fields.hpp"
#include "callables.hpp"
#include "keywords.hpp"
#include "option_fields.hpp"

namespace iksel::python {

/// What `closest` asks for: None, a bool, or six weights.
template <>
struct FromPython<std::optional<PoseWeights>> {
  static std::string text() { return "bool | numpy.typing.ArrayLike | None"; }
  static std::optional<PoseWeights> convert(py::handle value, const char* name);
  static py::object show(const std::optional<PoseWeights>& weights);
};

template <>
struct FromPython<std::vector<Task>> {
  static std::string text() {
    return "collections.abc.Sequence[Task | collections.abc.Mapping[str, object]]";
  }
  static std::vector<Task> convert(py::handle value, const char* name) {
    return read_sequence<Task>(value, name, "a list of Tasks, one for each tip");
  }
};

/// Numbers of tips; None is -1.
template <>
struct FromPython<std::vector<int>> {
  static std::string text() { return "collections.abc.Sequence[int | None]"; }
  static std::vector<int> convert(py::handle value, const char* name) {
    std::vector<int> frames;
    for (const auto& frame : read_sequence<std::optional<int>>(
             value, name, "a list of numbers of tips or None, one for each tip")) {
      frames.push_back(frame.value_or(-1));
    }
    return frames;
  }
};

/// The request that keywords ask for, but for the field `except`; warns of angles that look like
/// degrees.
SolveRequest read_request(const Solver& solver, const Given& given, const char* except = "");

/// The task of a request, or else the solver's.
inline const Task& task_of(const Solver& solver, const TargetCriteria& criteria) {
  return criteria.task ? *criteria.task : solver.options().task;
}

/// The pose of the one tip, or one for each.
std::vector<Pose> as_targets(const Solver& solver, py::handle poses,
                             const TargetCriteria& criteria);
/// Poses of many targets, one after the other: those of all tips at the first, at the second, ...
DoubleArray as_rows(const Solver& solver, py::handle poses, const TargetCriteria& criteria);

}  // namespace iksel::python
