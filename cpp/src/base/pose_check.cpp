// SPDX-License-Identifier: BSD-3-Clause
#include "base/pose_check.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "iksel/pose.hpp"

namespace iksel {
namespace {

bool is_affine(const Pose& pose) {
  const auto& T = pose.matrix();
  return T(3, 0) == 0 && T(3, 1) == 0 && T(3, 2) == 0 && T(3, 3) == 1;
}

/// Largest element of |R^T R - I|; infinite where that is not finite.
double deviation_of(const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d rest = R.transpose() * R - Eigen::Matrix3d::Identity();
  return rest.allFinite() ? rest.cwiseAbs().maxCoeff() : kInfinity;
}

}  // namespace

double rigid_deviation(const Pose& pose) {
  const Eigen::Matrix3d R = pose.linear();
  const Eigen::Vector3d p = pose.translation();
  const bool is_finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  return is_finite && is_affine(pose) && R.determinant() >= 0 ? deviation_of(R) : kInfinity;
}

Rigidity rigidity_of(const Pose& pose) {
  const double deviation = rigid_deviation(pose);
  if (deviation <= 1e-12) return Rigidity::exact;  // rounding leaves that in products of rotations
  return deviation <= kRigidTolerance ? Rigidity::close : Rigidity::none;
}

void make_rigid(Pose& pose) {
  // Newton-Schulz to the polar factor (Higham 2008, section 8.3): the deviation is squared by each
  // step, 1e-3 -> 1e-6 -> 1e-12 -> below rounding.
  Eigen::Matrix3d R = pose.linear();
  for (int step = 0; step < 3; ++step) {
    const Eigen::Matrix3d correction = 1.5 * Eigen::Matrix3d::Identity() - 0.5 * R.transpose() * R;
    R = (R * correction).eval();
  }
  pose.linear() = R;
}

void throw_not_rigid(const Pose& pose, const char* name, std::ptrdiff_t index) {
  if (!pose.matrix().allFinite()) throw_invalid(name, index, "not finite");
  MessageStream what;
  what << "not rigid, ";
  const Eigen::Matrix3d R = pose.linear();
  if (!is_affine(pose)) {
    // A difference that six digits do not show is shown by all.
    const auto row = pose.matrix().row(3);
    const bool is_near = (row - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < 1e-5;
    const int digits = is_near ? std::numeric_limits<double>::max_digits10 : 6;
    what << "the last row must be 0 0 0 1, not "
         << row.format(Eigen::IOFormat(digits, Eigen::DontAlignCols));
    if (pose.matrix().col(3) == Eigen::Vector4d::UnitW()) what << "; is it transposed?";
  } else if (deviation_of(R) <= kRigidTolerance) {
    what << "det R is negative (a reflection)";
  } else {
    what << "R^T R differs from the identity by " << deviation_of(R) << " (at most "
         << kRigidTolerance
         << " is taken for rounding); orthonormalized(pose) is the nearest rigid one";
  }
  throw_invalid(name, index, what.str());
}

const Pose& to_rigid(const Pose& pose, Pose& nearest, const char* name, std::ptrdiff_t index) {
  const Rigidity rigidity = rigidity_of(pose);
  if (rigidity == Rigidity::exact) return pose;
  if (rigidity == Rigidity::none) throw_not_rigid(pose, name, index);
  nearest = pose;
  make_rigid(nearest);
  return nearest;
}

Pose check_pose(const Pose& pose, const char* name) {
  Pose nearest;
  return to_rigid(pose, nearest, name);
}

Pose orthonormalized(const Pose& pose, const char* name) {
  if (rigidity_of(pose) == Rigidity::exact) return pose;
  if (!pose.matrix().allFinite() || !is_affine(pose)) throw_not_rigid(pose, name);
  // Newton's iteration to the polar factor, scaled so that it converges from afar (Higham 2008,
  // section 8.6).
  Eigen::Matrix3d X = pose.linear();
  X /= std::max(X.lpNorm<Eigen::Infinity>(), std::numeric_limits<double>::min());
  if (!(X.norm() * X.inverse().norm() < 1e9)) {
    throw_invalid(name, -1, "the matrix in place of the rotation is singular");
  }
  if (X.determinant() < 0) throw_invalid(name, -1, "det R is negative (a reflection)");
  for (int step = 0; step < 30 && deviation_of(X) > kRigidTolerance; ++step) {
    const Eigen::Matrix3d inverse = X.inverse().transpose();
    const double scale = std::sqrt(inverse.norm() / X.norm());
    X = (0.5 * (scale * X + inverse / scale)).eval();
  }
  Pose nearest = pose;
  nearest.linear() = X;
  make_rigid(nearest);
  return nearest;
}

}  // namespace iksel
