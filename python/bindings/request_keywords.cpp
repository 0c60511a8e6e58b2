// SPDX-License-Identifier: BSD-3-Clause
#include "request_keywords.hpp"

#include <algorithm>

#include "angle_warning.hpp"

namespace iksel::python {

using Closest = FromPython<std::optional<PoseWeights>>;

std::optional<PoseWeights> Closest::convert(py::handle value, const char* name) {
  if (value.is_none() || value.ptr() == Py_False) return std::nullopt;
  PoseWeights weights;
  if (value.ptr() == Py_True) return weights;
  const DoubleArray six =
      as_shaped(value, name, {6}, "True or six weights, of position and rotation");
  weights.rotation.emplace();
  std::copy_n(six.data(), 3, weights.position.begin());
  std::copy_n(six.data() + 3, 3, weights.rotation->begin());
  weights.validate();
  return weights;
}

py::object Closest::show(const std::optional<PoseWeights>& weights) {
  if (!weights) return py::none();
  if (!weights->rotation) return py::bool_(true);
  std::vector<double> six(weights->position.begin(), weights->position.end());
  six.insert(six.end(), weights->rotation->begin(), weights->rotation->end());
  return to_array(six);
}

namespace {

/// What a position alone stands for, if it is the same task for all tips; else null.
const Task* common_task(const Solver& solver, const TargetCriteria& criteria) {
  if (criteria.tasks.empty()) return &task_of(solver, criteria);
  for (const Task& task : criteria.tasks) {
    if (task != criteria.tasks.front()) return nullptr;
  }
  return &criteria.tasks.front();
}

}  // namespace

std::vector<Pose> as_targets(const Solver& solver, py::handle poses,
                             const TargetCriteria& criteria) {
  const int tips = solver.robot().tips();
  if (tips == 1) return {as_pose(poses, "pose", common_task(solver, criteria))};
  if (is_doubles(poses)) {
    const auto array = py::reinterpret_borrow<DoubleArray>(poses);
    if (array.ndim() == 4 || (array.ndim() == 2 && array.shape(1) == 4)) {
      throw_wrong_shape("pose", "one pose for each tip, (" + std::to_string(tips) + ", 4, 4)",
                        array, "; solve_batch() takes (N, k, 4, 4)");
    }
  }
  return to_poses(as_poses(poses, "pose", common_task(solver, criteria)));
}

DoubleArray as_rows(const Solver& solver, py::handle poses, const TargetCriteria& criteria) {
  const int tips = solver.robot().tips();
  if (tips == 1) return as_poses(poses, "poses", common_task(solver, criteria));
  const std::string expected = "an (N, " + std::to_string(tips) + ", 4, 4) array";
  const DoubleArray array = as_shaped(poses, "poses", {-1, tips, 4, 4}, expected.c_str());
  const std::vector<py::ssize_t> shape = {array.shape(0) * tips, 4, 4};
  return py::array(array).reshape(shape);
}

SolveRequest read_request(const Solver& solver, const Given& given, const char* except) {
  auto request = given.read<SolveRequest>(solver.robot().dof(), except);
  if (request.near) warn_of_degrees(solver.robot(), {*request.near}, "near");
  warn_of_degrees(solver.robot(), request.seeds, "seeds");
  return request;
}

}  // namespace iksel::python
