// SPDX-License-Identifier: BSD-3-Clause
// Keyword arguments as a SolveRequest.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <vector>

#include "array_checks.hpp"
#include "filter.hpp"
#include "iksel/request.hpp"
#include "iksel/solver.hpp"
#include "objective.hpp"
#include "python_types.hpp"
#include "task_fields.hpp"

namespace iksel::python {

/// An (N, dof) array of finite numbers.
inline std::vector<JointVector> as_seeds(const ArrayLike& value, int dof) {
  const DoubleArray array = as_doubles(value, "seeds");
  const std::string n = std::to_string(dof);
  if (array.ndim() != 2 || array.shape(1) != dof) {
    throw_wrong_shape("seeds", "an (N, " + n + ") array", array);
  }
  std::vector<JointVector> seeds;
  seeds.reserve(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    check_finite(array.data(i), dof, "seeds[" + std::to_string(i) + "]");
    seeds.emplace_back(Eigen::Map<const Eigen::VectorXd>(array.data(i), dof));
  }
  return seeds;
}

/// The task of a request, or else the solver's.
inline const Task& task_of(const Solver& solver, const SolveRequest& request) {
  return request.task ? *request.task : solver.options().task;
}

/// `filter` and `objective` must outlive the request.
inline SolveRequest make_request(int dof, const std::optional<ArrayLike>& near,
                                 const std::optional<ArrayLike>& weights,
                                 const Loose<MoveNorm>& norm, const std::optional<ArrayLike>& seeds,
                                 const Loose<bool>& database_seeds,
                                 const std::optional<FilterCallable>& filter,
                                 const std::optional<Loose<double>>& deadline,
                                 const std::optional<Loose<Task>>& task = {},
                                 const std::optional<ObjectiveLike>& objective = {}) {
  SolveRequest request;
  if (task) request.task = from_python<Task>(*task, "task");
  if (objective) request.objective = as_objective(*objective);
  if (near) request.near = as_joints(*near, dof, "near");
  if (weights) request.weights = as_joints(*weights, dof, "weights");
  request.norm = from_python<MoveNorm>(norm, "norm");
  if (seeds) request.seeds = as_seeds(*seeds, dof);
  request.database_seeds = from_python<bool>(database_seeds, "database_seeds");
  if (filter) request.filter = make_filter(*filter, dof);
  if (deadline) request.deadline = from_python<double>(*deadline, "deadline");
  return request;
}

}  // namespace iksel::python
