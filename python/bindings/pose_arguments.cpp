// SPDX-License-Identifier: BSD-3-Clause
#include "pose_arguments.hpp"

#include <pybind11/stl.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace iksel::python {
namespace {

py::module_ numpy() { return py::module_::import("numpy"); }

bool is_array(py::handle value) { return py::isinstance<py::array>(value); }

bool is_sequence(py::handle value) {
  return py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value);
}

/// Whether the last axes of `value` are rows x columns.
bool ends_with(const py::array& value, py::ssize_t rows, py::ssize_t columns) {
  const py::ssize_t n = value.ndim();
  return n >= 2 && value.shape(n - 2) == rows && value.shape(n - 1) == columns;
}

bool ends_with(const py::array& value, py::ssize_t length) {
  return value.ndim() >= 1 && value.shape(value.ndim() - 1) == length;
}

/// Numbers, or an empty array if the value is none (a ragged list, say).
py::array to_numbers(py::handle value) {
  if (is_array(value)) return py::reinterpret_borrow<py::array>(value);
  try {
    const auto array = py::array(numpy().attr("asarray")(value));
    return array.dtype().kind() == 'O' ? py::array() : array;
  } catch (const py::error_already_set&) {
    return {};
  }
}

/// What a message, or a mapping, has under a name; null if it has nothing there, or a method.
py::object field_of(py::handle value, const char* name) {
  py::object found;
  if (py::isinstance<py::dict>(value)) {
    const auto items = py::reinterpret_borrow<py::dict>(value);
    if (items.contains(name)) found = items[name];
  } else if (py::hasattr(value, name)) {
    found = value.attr(name);
  }
  return found && PyCallable_Check(found.ptr()) == 0 ? found : py::object();
}

/// The numbers that a message has under the names, each a letter; empty if not all are there.
std::vector<double> numbers_of(py::handle value, const std::string& names, const char* argument) {
  std::vector<double> numbers;
  if (is_array(value)) return numbers;
  for (const char name : names) {
    const py::object number = field_of(value, std::string(1, name).c_str());
    if (!number) return {};
    numbers.push_back(from_python<double>(number, argument));
  }
  return numbers;
}

/// The matrix of a pose whose position and quaternion have named fields: ROS's Pose and Transform,
/// and what holds one of them: PoseStamped, TransformStamped, PoseWithCovarianceStamped.
py::object matrix_of_message(py::handle value, const char* argument) {
  if (is_array(value)) return {};
  for (const char* inner : {"pose", "transform"}) {
    const py::object message = field_of(value, inner);
    if (message) return matrix_of_message(message, argument);
  }
  for (const auto& [first, second] :
       {std::pair("position", "orientation"), std::pair("translation", "rotation")}) {
    const py::object position = field_of(value, first);
    const py::object rotation = field_of(value, second);
    if (!position || !rotation) continue;
    const std::vector<double> p = numbers_of(position, "xyz", argument);
    const std::vector<double> q = numbers_of(rotation, "xyzw", argument);
    if (p.empty() || q.empty()) continue;
    const Eigen::Quaterniond quaternion(q[3], q[0], q[1], q[2]);
    if (!(std::abs(quaternion.norm() - 1) <= kRigidTolerance)) {
      throw InvalidArgumentError(
          std::string(argument) + ": its " + second +
          " is no unit quaternion: x, y, z, w = " + py::cast<std::string>(py::str(py::cast(q))) +
          (quaternion.norm() == 0 ? ", as in a message that was not filled in" : ""));
    }
    Pose pose = Pose::Identity();
    pose.linear() = quaternion.normalized().toRotationMatrix();
    pose.translation() << p[0], p[1], p[2];
    return to_array(pose);
  }
  return {};
}

/// The matrix that an object of another library has for itself: scipy's Rotation and
/// RigidTransform, Pinocchio's SE3, and the SE3 and UnitQuaternion of spatialmath.
py::object matrix_of(py::handle value) {
  if (is_array(value) || is_sequence(value)) return {};
  if (py::hasattr(value, "as_matrix")) return value.attr("as_matrix")();
  if (py::hasattr(value, "homogeneous")) return value.attr("homogeneous");
  if (!py::hasattr(value, "A")) return {};
  // A quaternion's A are its four numbers, a scalar and a vector.
  const bool is_quaternion = py::hasattr(value, "s") && py::hasattr(value, "v");
  return value.attr(is_quaternion && py::hasattr(value, "R") ? "R" : "A");
}

[[noreturn]] void throw_quaternion(const char* name) {
  throw InvalidArgumentError(
      std::string(name) +
      ": a position and a quaternion do not say in which order the quaternion is; name it: "
      "iksel.as_pose(value, order=\"wxyz\") or order=\"xyzw\"");
}

/// The rotation matrix of a rotation or matrix, or whatever numbers it is.
py::array rotation_of(py::handle value) {
  const py::object matrix = matrix_of(value);
  return to_numbers(matrix ? matrix : py::reinterpret_borrow<py::object>(value));
}

/// Whether `value` is (position, rotation or quaternion): one pose or several.
bool is_pair(py::handle value) {
  if (!is_sequence(value) || py::len(value) != 2) return false;
  const auto pair = py::reinterpret_borrow<py::sequence>(value);
  const py::array position = to_numbers(pair[0]);
  if (!ends_with(position, 3)) return false;
  const py::array R = rotation_of(pair[1]);
  if (ends_with(R, 4)) return R.ndim() <= position.ndim();
  if (!ends_with(R, 3, 3)) return false;
  // Two matrices (3, 3) are no pair; three positions with rotations are.
  const bool is_matrix = is_array(pair[1]) || is_sequence(pair[1]);
  return !ends_with(position, 3, 3) || R.ndim() > position.ndim() || !is_matrix;
}

/// Poses (..., 4, 4) from positions (..., 3) and rotation matrices (..., 3, 3).
py::object assemble(const py::array& p, const py::array& R) {
  const py::module_ np = numpy();
  const py::ellipsis all;
  const py::slice three(0, 3, 1);
  const py::tuple lead =
      np.attr("broadcast_shapes")(p.attr("shape")[py::slice(0, p.ndim() - 1, 1)],
                                  R.attr("shape")[py::slice(0, R.ndim() - 2, 1)]);
  py::object T = np.attr("zeros")(lead + py::make_tuple(4, 4));
  T[py::make_tuple(all, three, three)] = R;
  T[py::make_tuple(all, three, 3)] = p;
  T[py::make_tuple(all, 3, 3)] = 1.0;
  return T;
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

/// (..., 3, 4) with the row 0 0 0 1 below.
py::object with_last_row(const py::array& rows) {
  const py::module_ np = numpy();
  const py::object last = np.attr("array")(py::make_tuple(py::make_tuple(0.0, 0.0, 0.0, 1.0)));
  const py::tuple lead = rows.attr("shape")[py::slice(0, rows.ndim() - 2, 1)];
  const py::object below = np.attr("broadcast_to")(last, lead + py::make_tuple(1, 4));
  return np.attr("concatenate")(py::make_tuple(rows, below), py::arg("axis") = -2);
}

}  // namespace

py::object to_matrices(py::handle value, const char* name) {
  if (is_pair(value)) {
    const auto pair = py::reinterpret_borrow<py::sequence>(value);
    const py::array R = rotation_of(pair[1]);
    if (!ends_with(R, 3, 3)) throw_quaternion(name);
    return assemble(to_numbers(pair[0]), R);
  }
  if (const py::object message = matrix_of_message(value, name)) return message;
  if (const py::object poses = field_of(value, "poses")) {  // of ROS's PoseArray and Path
    return to_matrices(py::list(poses), name);
  }
  if (const py::object matrix = matrix_of(value)) {
    if (ends_with(to_numbers(matrix), 3, 3)) {
      throw_wrong_type(name, "a pose, or a pair (position, rotation)", value);
    }
    return to_matrices(matrix, name);
  }
  if (is_sequence(value) && py::len(value) > 0) {
    const auto items = py::reinterpret_borrow<py::sequence>(value);
    if (is_pair(items[0]) || matrix_of(items[0]) || matrix_of_message(items[0], name)) {
      py::list matrices;
      for (const py::handle item : items) matrices.append(to_matrices(item, name));
      return matrices;
    }
  }
  const py::array numbers = to_numbers(value);
  if (ends_with(numbers, 3, 4)) return with_last_row(numbers);
  if (ends_with(numbers, 7)) throw_quaternion(name);
  if (numbers.size() > 0) return numbers;
  refuse_gradients(value, name);
  return py::reinterpret_borrow<py::object>(value);
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
    return array.ndim() == 3 && array.shape(1) == 4 && array.shape(2) == 4;
  };
  if (is_doubles(value)) {
    auto array = py::reinterpret_borrow<DoubleArray>(value);
    if (is_stack(array)) return array;
  }
  DoubleArray array = as_doubles(to_matrices(value, name), name);
  if (array.ndim() == 2 && array.shape(1) == 3) {
    require_free_rotation(task, name);
    return as_doubles(assemble(array, numpy().attr("eye")(3)), name);
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
