// SPDX-License-Identifier: BSD-3-Clause
// Poses by themselves: what counts as one, and how far two are apart.
#include "bindings.hpp"

namespace iksel::python {

namespace {

/// Matrices of any leading shape, (..., 4, 4).
DoubleArray as_matrices(py::handle value, const char* name) {
  DoubleArray array = as_doubles(to_matrices(value, name), name);
  const py::ssize_t n = array.ndim();
  if (n < 2 || array.shape(n - 2) != 4 || array.shape(n - 1) != 4) {
    throw_wrong_shape(name, "a (..., 4, 4) array", array);
  }
  return array;
}

py::ssize_t count_of(const py::array& matrices) { return matrices.size() / 16; }

Pose pose_at(const DoubleArray& matrices, py::ssize_t i) {
  Pose pose;
  pose.matrix() = Eigen::Map<const RowMajorPose>(matrices.data() + 16 * i);
  return pose;
}

/// "pose[2, 0]": element i of the leading axes; "pose" if there are none.
std::string element_name(const py::array& matrices, py::ssize_t i, const std::string& name) {
  std::string index;
  for (py::ssize_t axis = matrices.ndim() - 2; axis-- > 0;) {
    const py::ssize_t extent = matrices.shape(axis);
    index = std::to_string(i % extent) + (index.empty() ? "" : ", ") + index;
    i /= extent;
  }
  return index.empty() ? name : name + "[" + index + "]";
}

/// The poses themselves if function(pose, name) changes none, else a copy with the changed ones.
template <class Function>
DoubleArray map_poses(const DoubleArray& poses, const std::string& name, const Function& function) {
  std::optional<DoubleArray> out;
  InterruptCheck check_interrupt;
  for (py::ssize_t i = 0; i < count_of(poses); ++i) {
    check_interrupt();
    const Pose given = pose_at(poses, i);
    Pose made;
    try {
      made = function(given, name.c_str());
    } catch (const InvalidArgumentError&) {
      // Once more, for the error that names the element.
      if (poses.ndim() > 2) function(given, element_name(poses, i, name).c_str());
      throw;
    }
    if (made.matrix() == given.matrix()) continue;
    if (!out) out = py::cast<DoubleArray>(poses.attr("copy")());
    Eigen::Map<RowMajorPose>(out->mutable_data() + 16 * i) = made.matrix();
  }
  return out ? *out : poses;
}

py::array_t<double> rigid_deviations(const PoseLike& value) {
  const DoubleArray poses = as_matrices(value, "pose");
  py::array_t<double> out(
      std::vector<py::ssize_t>(poses.shape(), poses.shape() + poses.ndim() - 2));
  for (py::ssize_t i = 0; i < count_of(poses); ++i) {
    out.mutable_data()[i] = rigid_deviation(pose_at(poses, i));
  }
  return out;
}

DoubleArray checked(const PoseLike& pose, const std::string& name) {
  return map_poses(as_matrices(pose, name.c_str()), name,
                   [](const Pose& given, const char* of) { return check_pose(given, of); });
}

/// Row i of the result: the error between poses[i] and targets[i].
py::array_t<double> pose_errors(const PoseLike& target, const PoseLike& pose) {
  const DoubleArray targets = checked(target, "target");
  const DoubleArray poses = checked(pose, "pose");
  if (targets.ndim() != poses.ndim() ||
      !std::equal(targets.shape(), targets.shape() + targets.ndim(), poses.shape())) {
    throw_wrong_shape("pose", "as many poses as targets, shape " + shape_text(targets), poses);
  }
  std::vector<py::ssize_t> shape(targets.shape(), targets.shape() + targets.ndim() - 2);
  shape.push_back(6);
  py::array_t<double> out(shape);
  double* to = out.mutable_data();
  const GilRelease release;
  InterruptCheck check_interrupt;
  for (py::ssize_t i = 0; i < count_of(poses); ++i, to += 6) {
    check_interrupt();
    Eigen::Map<Eigen::Matrix<double, 6, 1>>{to} =
        pose_error(pose_at(targets, i), pose_at(poses, i));
  }
  return out;
}

DoubleArray orthonormal(const PoseLike& pose) {
  return map_poses(as_matrices(pose, "pose"), "pose",
                   [](const Pose& given, const char* of) { return orthonormalized(given, of); });
}

}  // namespace

void bind_pose(py::module_& m) {
  m.attr("RIGID_TOLERANCE") = kRigidTolerance;
  // What users see of these are the functions of iksel.pose.
  def(m, "pose_error", "target, pose", fn<&pose_errors>);
  def(m, "check_pose", "pose, name='pose'", fn<&checked>);
  def(m, "orthonormalized", "pose", fn<&orthonormal>);
  def(m, "rigid_deviation", "pose", fn<&rigid_deviations>);
  def(
      m, "pose_matrices", "pose, name='pose'",
      [](const PoseLike& pose, const std::string& name) { return to_matrices(pose, name.c_str()); },
      "Poses in one of the forms that as_pose of iksel lists as matrices (..., 4, 4), not checked; "
      "what is none of them as it is.");
}

}  // namespace iksel::python
