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

/// Deviation that rounding leaves in products of rotations; such a pose is taken bit for bit.
constexpr double kExact = 1e-12;

bool is_affine(const Pose& pose) {
  const auto& T = pose.matrix();
  return T(3, 0) == 0 && T(3, 1) == 0 && T(3, 2) == 0 && T(3, 3) == 1;
}

/// Largest element of |R^T R - I|; infinite where R is not finite.
double deviation_of(const Eigen::Matrix3d& R) {
  const auto gram = [&](int i, int k) {
    return R(0, i) * R(0, k) + R(1, i) * R(1, k) + R(2, i) * R(2, k);
  };
  const double xx = gram(0, 0);
  const double yy = gram(1, 1);
  const double zz = gram(2, 2);
  // Squares that overflow make the other elements NaN.
  if (!(xx + yy + zz < kInfinity)) return kInfinity;
  const double along = std::max({std::abs(xx - 1), std::abs(yy - 1), std::abs(zz - 1)});
  return std::max({along, std::abs(gram(0, 1)), std::abs(gram(0, 2)), std::abs(gram(1, 2))});
}

}  // namespace

double rigid_deviation(const Pose& pose) {
  const Eigen::Matrix3d R = pose.linear();
  const Eigen::Vector3d p = pose.translation();
  const bool is_finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  if (!is_finite || !is_affine(pose) || R.determinant() < 0) {
    return kInfinity;
  }
  return deviation_of(R);
}

Rigidity rigidity_of(const Pose& pose) {
  const double deviation = rigid_deviation(pose);
  if (deviation <= kExact) return Rigidity::exact;
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
  constexpr double kMostCondition = 1e9;
  if (!(X.norm() * X.inverse().norm() < kMostCondition)) {
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
