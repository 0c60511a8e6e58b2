// SPDX-License-Identifier: BSD-3-Clause
// Poses as people hold them: matrices, pairs of a position and a rotation, and objects of other
// libraries, told by what they can do and not by their type. A (4, 4) or (N, 4, 4) array of doubles
// in C order is read in place.
#pragma once

#include <vector>

#include "array_checks.hpp"
#include "python_types.hpp"

namespace iksel::python {

/// Anything that as_pose or as_poses takes.
struct PoseLike : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "numpy.typing.ArrayLike | object";
};

/// What iksel._base.pose_forms makes of what people hold: matrices (..., 4, 4), or what it is.
py::object to_matrices(py::handle value, const char* name);

/// For what is not simply a (4, 4) array of doubles; `task` may be null.
Pose convert_to_pose(py::handle value, const char* name, const Task* task);

/// One pose. That it is rigid is checked by what uses it. With a `task` that leaves the whole
/// rotation free, a position (3,) will do.
inline Pose as_pose(py::handle value, const char* name, const Task* task = nullptr) {
  if (is_doubles(value)) {
    const auto array = py::reinterpret_borrow<DoubleArray>(value);
    if (array.ndim() == 2 && array.shape(0) == 4 && array.shape(1) == 4) {
      Pose pose;
      pose.matrix() = Eigen::Map<const RowMajorPose>(array.data());
      return pose;
    }
  }
  return convert_to_pose(value, name, task);
}

/// One pose, as an argument of which nothing else has to be known.
template <>
struct FromPython<Pose> {
  static std::string text() { return PoseLike::kText; }
  static Pose convert(py::handle value, const char* name) { return as_pose(value, name); }
  static py::array_t<double> show(const Pose& value) { return to_array(value); }
};

/// Poses as an (N, 4, 4) array, or positions (N, 3) as above.
DoubleArray as_poses(py::handle value, const char* name, const Task* task = nullptr);

/// The poses of such an array, and back: (k, 4, 4).
std::vector<Pose> to_poses(const DoubleArray& array);
template <class Poses>
py::array_t<double> to_stack(const Poses& poses) {
  py::array_t<double> array(
      {static_cast<py::ssize_t>(poses.size()), py::ssize_t{4}, py::ssize_t{4}});
  double* out = array.mutable_data();
  for (const auto& pose : poses) {
    Eigen::Map<RowMajorPose>{out} = pose.matrix();
    out += 16;
  }
  return array;
}

}  // namespace iksel::python
