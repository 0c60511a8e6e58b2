// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

namespace iksel::python {

namespace {

py::array_t<double> fk(const Robot& self, const ArrayLike& q, Kinematics how) {
  const py::ssize_t tips = self.tips();
  std::vector<py::ssize_t> shape = {4, 4};
  if (tips > 1) shape.insert(shape.begin(), tips);
  return map_joints(q, self.dof(), "q", std::move(shape),
                    [&self, how, tips](const JointVector& joints, double* out) {
                      if (tips == 1) {
                        Eigen::Map<RowMajorPose>{out} = self.fk(joints, how).matrix();
                        return;
                      }
                      for (const Pose& pose : self.tip_poses(joints, how)) {
                        Eigen::Map<RowMajorPose>{out} = pose.matrix();
                        out += 16;
                      }
                    });
}

py::array_t<double> jacobian(const Robot& self, const ArrayLike& q, Kinematics how) {
  const int rows = 6 * self.tips();
  const int dof = self.dof();
  return map_joints(q, dof, "q", {rows, dof},
                    [&self, how, rows, dof](const JointVector& joints, double* out) {
                      Eigen::Map<RowMajorMatrix> all(out, rows, dof);
                      if (rows == 6) {
                        all = self.jacobian(joints, how);
                      } else {
                        all = self.tip_jacobians(joints, how);
                      }
                    });
}

py::array_t<double> link_poses(const Robot& self, const ArrayLike& q,
                               const std::optional<JointValues>& other_joints) {
  const JointValues others = other_joints.value_or(JointValues());
  const auto links = static_cast<py::ssize_t>(self.link_names().size());
  return map_joint_blocks<double>(q, self.dof(), "q", {links, 4, 4},
                                  [&](const double* rows, std::size_t count, double* out) {
                                    self.link_poses(rows, count, others, out);
                                  });
}

py::array_t<double> inverse_jacobian(const Robot& self, const ArrayLike& q, double damping) {
  const int dof = self.dof();
  return map_joints(q, dof, "q", {dof, 6}, [&](const JointVector& joints, double* out) {
    Eigen::Map<RowMajorMatrix>(out, dof, 6) = self.inverse_jacobian(joints, damping);
  });
}

void bind_jacobians(py::class_<Robot>& cls) {
  def(cls, "jacobian", "q, kinematics='kernel'", fn<&jacobian>,
      R"(Geometric Jacobian: rows [linear; angular] in base axes at the TCP.

Args:
    q: joint values [rad or m], (dof,) or (N, dof).
    kinematics: what computes it.

Returns:
    (6, dof), or (N, 6, dof) with the GIL released; of k tips 6 k rows, one below the other.

Raises:
    InvalidArgumentError: wrong shape or dtype, or a number that is not finite.)");
  def(cls, "inverse_jacobian", "q, damping=0.0", fn<&inverse_jacobian>,
      R"(Derivative of an answer q by its target, for differentiable use.

dq = inverse_jacobian @ [linear; angular] for a small twist of the target in base axes at the TCP,
of all dq the least: the damped pseudo-inverse J^T (J J^T + damping^2 I)^-1 (Nakamura and Hanafusa 1986).

Args:
    q: joint values [rad or m], (dof,) or (N, dof).
    damping: bounds dq near singularities; 0: the pseudo-inverse.

Returns:
    (dof, 6), or (N, dof, 6) with the GIL released.

Raises:
    InvalidArgumentError: wrong shape or dtype, a number that is not finite, damping below 0.)");
}

}  // namespace

void bind_kinematics(py::class_<Robot>& cls) {
  def(cls, "fk", "q, kinematics='kernel'", fn<&fk>,
      R"(Forward kinematics: T_base_tip, of the TCP if there is a tool.

Args:
    q: joint values [rad or m], (dof,) or (N, dof).
    kinematics: what computes it.

Returns:
    (4, 4), or (N, 4, 4) with the GIL released; of k tips (k, 4, 4), or (N, k, 4, 4).

Raises:
    InvalidArgumentError: wrong shape or dtype, or a number that is not finite.)");
  def(cls, "link_poses", "q, *, other_joints=None", fn<&link_poses>,
      R"(Poses of all links of the URDF in the base link's frame, in the order of link_names.

Side branches move with the arm's joints, too, and with what mimics them at any depth. The TCP plays
no part.

Args:
    q: joint values [rad or m], (dof,) or (N, dof).
    other_joints: values of joints that q does not move [rad or m], by name. Those not given are
        where they are locked, or at 0; floating and planar joints are at their origin.

Returns:
    (n_links, 4, 4), or (N, n_links, 4, 4) with the GIL released.

Raises:
    InvalidArgumentError: wrong shape or dtype, a number that is not finite, or a joint in
        other_joints that q moves.
    UnknownNameError: a name in other_joints, or in a mimic tag, that is no joint's.
    UrdfError: a joint off the chain is no good: it mimics itself, or has no axis.)");
  bind_jacobians(cls);
}

}  // namespace iksel::python
