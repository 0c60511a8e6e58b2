// SPDX-License-Identifier: BSD-3-Clause
#include "error_check.hpp"

#include <cmath>

#include "iksel/error.hpp"
#include "iksel/robot.hpp"
#include "message_text.hpp"

namespace iksel {
namespace {

/// Float32 matrices pass, a sheared or mirrored one does not.
constexpr double kRigidTolerance = 1e-6;

[[noreturn]] void fail(const char* name, std::ptrdiff_t index, const std::string& what) {
  MessageStream text;
  text << name;
  if (index >= 0) text << "[" << index << "]";
  text << ": " << what;
  throw InvalidArgumentError(text.str());
}

void check_rigid(const Eigen::Matrix4d& T, const char* name, std::ptrdiff_t index) {
  if (!T.allFinite()) fail(name, index, "not finite");
  if (T.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    MessageStream row;
    row << "the last row must be 0 0 0 1, not " << T.row(3);
    fail(name, index, row.str());
  }
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  const double error = (R.transpose() * R - Eigen::Matrix3d::Identity()).lpNorm<Eigen::Infinity>();
  if (error > kRigidTolerance) {
    MessageStream what;
    what << "not a rotation: R^T R differs from the identity by " << error << " (at most "
         << kRigidTolerance << " is accepted)";
    fail(name, index, what.str());
  }
  if (R.determinant() < 0) fail(name, index, "a mirror image: the rotation has determinant -1");
}

}  // namespace

void check_joints(const JointVector& q, int dof, const char* name) {
  if (q.size() != dof) {
    fail(name, -1,
         "expected " + std::to_string(dof) + " joint values, got " + std::to_string(q.size()));
  }
  for (int i = 0; i < dof; ++i) {
    if (!std::isfinite(q[i])) fail(name, i, "not finite");
  }
}

void check_matrix(const double* row_major, const char* name, std::ptrdiff_t index) {
  check_rigid(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(row_major), name,
              index);
}

void check_pose(const Pose& pose, const char* name) { check_rigid(pose.matrix(), name, -1); }

}  // namespace iksel
