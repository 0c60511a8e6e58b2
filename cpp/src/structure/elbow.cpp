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
  if (model.dof != kCurveJoints || !is_simple(model)) return std::nullopt;
  for (const KernelJoint& joint : model.kernel.joints) {
    if (joint.prismatic) return std::nullopt;
  }
  Elbow elbow;
  elbow.axes_ = ScrewAxes::of(model);
  const ScrewAxes& axes = elbow.axes_;
  // Whether the three axes of shoulder and wrist meet in one point each.
  const auto do_meet = [&](double tolerance) {
    const AxisPattern pattern(axes, model.reach, tolerance);
    return pattern.has({AxisRun::Lie::meet, 0, 3}) && pattern.has({AxisRun::Lie::meet, 4, 3});
  };
  if (!do_meet(kSweptTolerance)) return std::nullopt;
  elbow.shoulder_ = axes.middle(0, 1);
  elbow.wrist_ = axes.middle(4, 5);
  elbow.elbow_ = axes.p[3] + axes.h[3] * axes.h[3].dot(elbow.shoulder_ - axes.p[3]);
  elbow.goes_round_ = do_meet(kStructureTolerance);
  for (const std::size_t i : {0, 1, 4, 5}) {
    const bool is_right = std::abs(axes.h[i].dot(axes.h[i + 1])) <= kStructureTolerance;
    elbow.goes_round_ = elbow.goes_round_ && is_right;
  }
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
  const auto turn = [&](std::size_t j) {
    return Eigen::AngleAxisd(q[j] + offset_[j], axes_.h[j]).toRotationMatrix();
  };
  const Eigen::Matrix3d upper = turn(0) * turn(1) * turn(2);
  const Vector3d to_elbow = upper * (elbow_ - shoulder_);
  const Vector3d to_wrist = to_elbow + upper * (turn(3) * (wrist_ - elbow_));
  const Vector3d line = to_wrist.normalized();
  const Vector3d from = axes_.h[0] - line * line.dot(axes_.h[0]);
  const Vector3d side = to_elbow - line * line.dot(to_elbow);
  if (!(from.norm() > kRounding && side.norm() > kRounding * to_elbow.norm())) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return std::atan2(line.dot(from.cross(side)), from.dot(side));
}

}  // namespace iksel
