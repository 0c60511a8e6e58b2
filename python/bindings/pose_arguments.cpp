// SPDX-License-Identifier: BSD-3-Clause
#include "pose_arguments.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace iksel::python {
namespace {

/// Whether it ends with axes of 4 and 4.
bool has_matrices(const py::array& array) {
  const py::ssize_t n = array.ndim();
  return n >= 2 && array.shape(n - 2) == 4 && array.shape(n - 1) == 4;
}

/// Throws unless the task leaves all of the rotation free, so that a position says enough.
void require_free_rotation(const Task* task, const char* name) {
  const auto is_free = [&](std::size_t i) {
    return std::isinf(task->rotation_lower[i]) && std::isinf(task->rotation_upper[i]);
  };
  if (task != nullptr && is_free(0) && is_free(1) && is_free(2)) return;
  throw InvalidArgumentError(
      std::string(name) + ": a position says nothing of the rotation: give a (4, 4) pose, or " +
      (task != nullptr ? "leave the rotation free by task=Task.position_only()"
                       : "a pair (position, rotation)"));
}

}  // namespace

py::object to_matrices(py::handle value, const char* name) {
  if (py::isinstance<py::array>(value) && has_matrices(py::reinterpret_borrow<py::array>(value))) {
    return py::reinterpret_borrow<py::object>(value);
  }
  refuse_masked(value, name);
  static const py::handle function = of_package("iksel._base.pose_forms", "to_matrices").release();
  const py::object matrices = function(value, name);
  if (matrices.is(value)) refuse_gradients(value, name);
  return matrices;
}

Pose convert_to_pose(py::handle value, const char* name, const Task* task) {
  const DoubleArray array = as_doubles(to_matrices(value, name), name);
  Pose pose = Pose::Identity();
  if (array.ndim() == 1 && array.shape(0) == 3) {
    require_free_rotation(task, name);
    pose.translation() = Eigen::Map<const Eigen::Vector3d>(array.data());
    return pose;
  }
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4) {
    const bool six = array.ndim() == 1 && array.shape(0) == 6;
    throw_wrong_shape(name, "a (4, 4) array", array,
                      six ? "; position and roll, pitch, yaw make a pose by "
                            "iksel.pose_from_euler(position, rpy)"
                          : "");
  }
  pose.matrix() = Eigen::Map<const RowMajorPose>(array.data());
  return pose;
}

DoubleArray as_poses(py::handle value, const char* name, const Task* task) {
  const auto is_stack = [](const py::array& array) {
    return array.ndim() == 3 && has_matrices(array);
  };
  if (is_doubles(value)) {
    auto array = py::reinterpret_borrow<DoubleArray>(value);
    if (is_stack(array)) return array;
  }
  DoubleArray array = as_doubles(to_matrices(value, name), name);
  if (array.ndim() == 2 && array.shape(1) == 3) {
    require_free_rotation(task, name);
    std::vector<Pose> poses(static_cast<std::size_t>(array.shape(0)), Pose::Identity());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i].translation() = Eigen::Map<const Eigen::Vector3d>(array.data() + 3 * i);
    }
    return to_stack(poses);
  }
  if (!is_stack(array)) {
    const bool single = array.ndim() == 2 && array.shape(0) == 4 && array.shape(1) == 4;
    throw_wrong_shape(name, "an (N, 4, 4) array", array,
                      single ? "; solve() takes a single pose" : "");
  }
  return array;
}

std::vector<Pose> to_poses(const DoubleArray& array) {
  std::vector<Pose> poses(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].matrix() = Eigen::Map<const RowMajorPose>(array.data() + 16 * i);
  }
  return poses;
}

}  // namespace iksel::python
