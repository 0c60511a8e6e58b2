// SPDX-License-Identifier: BSD-3-Clause
// The keywords of Solver's methods, as iksel/request.hpp and iksel/path.hpp declare them.
#pragma once

#include <optional>
#include <vector>

#include "iksel/request.hpp"
#include "iksel/solver.hpp"
#include "keywords.hpp"

namespace iksel::python {

/// Of SolveRequest.
std::vector<Keyword> request_keywords();
/// Of SolveAllOptions and SolveRequest.
std::vector<Keyword> solve_all_keywords();
/// Of PathOptions.
std::vector<Keyword> path_keywords();

/// The request that keywords ask for, but for the field `except`; warns of angles that look like
/// degrees.
SolveRequest read_request(const Solver& solver, const Given& given, const char* except = "");

/// What `closest` may be: see as_closest.
struct ClosestLike : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "bool | numpy.typing.ArrayLike | None";
};

/// What `closest` asks for: None, a bool, or six weights.
std::optional<PoseWeights> as_closest(py::handle given);

/// The task of a request, or else the solver's.
inline const Task& task_of(const Solver& solver, const AnswerCriteria& criteria) {
  return criteria.task ? *criteria.task : solver.options().task;
}

/// The pose of the one tip, or one for each.
std::vector<Pose> as_targets(const Solver& solver, py::handle poses,
                             const AnswerCriteria& criteria);
/// Poses of many targets, one after the other: those of all tips at the first, at the second, ...
DoubleArray as_rows(const Solver& solver, py::handle poses, const AnswerCriteria& criteria);

}  // namespace iksel::python
