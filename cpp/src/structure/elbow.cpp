// SPDX-License-Identifier: BSD-3-Clause
#include "structure/elbow.hpp"

#include <cmath>
#include <limits>

#include "base/constants.hpp"
#include "simd/lane_chain.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

using Eigen::Vector3d;

std::optional<Elbow> Elbow::of(const ChainModel& model) {
  constexpr double kParallel = 1e-3;
  if (model.dof != kCurveJoints || !is_simple(model)) return std::nullopt;
  for (const KernelJoint& joint : model.kernel.joints) {
    if (joint.prismatic) return std::nullopt;
  }
  Elbow elbow;
  elbow.axes_ = ScrewAxes::of(model);
  const ScrewAxes& axes = elbow.axes_;
  // Whether three axes from one on go through a point, up to a tolerance [in units of the reach].
  const auto meet_in = [&](const Vector3d& point, std::size_t i, double tolerance) {
    const double most = tolerance * model.reach;
    return axes.distance(i, point) <= most && axes.distance(i + 1, point) <= most &&
           axes.distance(i + 2, point) <= most;
  };
  // Where they meet.
  const auto centre = [&](std::size_t i, Vector3d& point) {
    if (axes.angle(i, i + 1) <= kParallel || axes.angle(i + 1, i + 2) <= kParallel) return false;
    point = axes.middle(i, i + 1);
    return meet_in(point, i, kSweptTolerance);
  };
  if (!centre(0, elbow.shoulder_) || !centre(4, elbow.wrist_)) return std::nullopt;
  elbow.elbow_ = axes.p[3] + axes.h[3] * axes.h[3].dot(elbow.shoulder_ - axes.p[3]);
  const auto is_spherical = [&](const Vector3d& point, std::size_t i) {
    return meet_in(point, i, kStructureTolerance) &&
           std::abs(axes.h[i].dot(axes.h[i + 1])) <= kStructureTolerance &&
           std::abs(axes.h[i + 1].dot(axes.h[i + 2])) <= kStructureTolerance;
  };
  elbow.goes_round_ = is_spherical(elbow.shoulder_, 0) && is_spherical(elbow.wrist_, 4);
  for (std::size_t j = 0; j < 4; ++j) elbow.offset_[j] = model.kernel.joints[j].offset;
  return elbow;
}

double Elbow::first_joint_to_plane(const Pose& Y) const {
  // The first axis is z. The second, h, is across the upper arm: it has to be across the way to the
  // wrist.
  const Vector3d w = Y * (axes_.end.inverse() * wrist_) - shoulder_;
  const Vector3d& h = axes_.h[1];
  return std::atan2(-(h.x() * w.x() + h.y() * w.y()), h.x() * w.y() - h.y() * w.x()) - offset_[0];
}

double Elbow::angle(const double* q) const {
  constexpr double kTooShort = 1e-9;
  const auto turn = [&](std::size_t j) {
    return Eigen::AngleAxisd(q[j] + offset_[j], axes_.h[j]).toRotationMatrix();
  };
  const Eigen::Matrix3d upper = turn(0) * turn(1) * turn(2);
  const Vector3d to_elbow = upper * (elbow_ - shoulder_);
  const Vector3d to_wrist = to_elbow + upper * (turn(3) * (wrist_ - elbow_));
  const Vector3d line = to_wrist.normalized();
  const Vector3d from = axes_.h[0] - line * line.dot(axes_.h[0]);
  const Vector3d side = to_elbow - line * line.dot(to_elbow);
  if (!(from.norm() > kTooShort && side.norm() > kTooShort * to_elbow.norm())) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return std::atan2(line.dot(from.cross(side)), from.dot(side));
}

}  // namespace iksel
