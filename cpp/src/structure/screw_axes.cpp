// SPDX-License-Identifier: BSD-3-Clause
#include "structure/screw_axes.hpp"

#include <algorithm>

namespace iksel {

ScrewAxes ScrewAxes::of(const ChainModel& model) {
  ScrewAxes axes;
  Pose frame = Pose::Identity();
  bool first = true;
  for (const KernelJoint& joint : model.kernel.joints) {
    if (!first) {
      Pose step = Pose::Identity();
      step.translation() << joint.p[0], joint.p[1], joint.p[2];
      step.linear() << 1, 0, 0, 0, joint.cos_alpha, -joint.sin_alpha, 0, joint.sin_alpha,
          joint.cos_alpha;
      frame = frame * step;
    }
    first = false;
    if (joint.prismatic) {
      Pose turn = Pose::Identity();
      turn.linear() << joint.cos_turn, -joint.sin_turn, 0, joint.sin_turn, joint.cos_turn, 0, 0, 0,
          1;
      frame = frame * turn;
    }
    axes.h.emplace_back(frame.linear().col(2));
    axes.p.emplace_back(frame.translation());
  }
  axes.end = frame;
  return axes;
}

ScrewAxes ScrewAxes::reversed() const {
  ScrewAxes axes;
  axes.end = end.inverse();
  for (std::size_t i = h.size(); i-- > 0;) {
    axes.h.emplace_back(-(axes.end.linear() * h[i]));
    axes.p.emplace_back(axes.end * p[i]);
  }
  return axes;
}

Eigen::Vector3d ScrewAxes::middle(std::size_t i, std::size_t j) const {
  const Eigen::Vector3d normal = h[i].cross(h[j]);
  const Eigen::Vector3d between = p[j] - p[i];
  const double sine2 = normal.squaredNorm();
  const Eigen::Vector3d on_i = p[i] + between.cross(h[j]).dot(normal) / sine2 * h[i];
  const Eigen::Vector3d on_j = p[j] + between.cross(h[i]).dot(normal) / sine2 * h[j];
  return (on_i + on_j) / 2;
}

}  // namespace iksel
