// SPDX-License-Identifier: BSD-3-Clause
#include "structure/screw_axes.hpp"

#include <algorithm>
#include <utility>

#include "structure/closed_form.hpp"

namespace iksel {

using Eigen::Vector3d;
using lanes::Closure;

ScrewAxes ScrewAxes::of(const ChainModel& model) {
  KernelChain chain = model.kernel;
  chain.base = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
  double q[kMaxDof];
  for (const KernelJoint& joint : chain.joints) q[joint.variable] = -joint.offset;
  JointAxes at;
  ScrewAxes axes;
  axes.end = to_pose(forward_to_last_joint(chain, q, &at));
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    axes.h.emplace_back(at.axis[k]);
    axes.p.emplace_back(at.origin[k]);
  }
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

AxisPattern::AxisPattern(ScrewAxes axes, double reach, double tolerance)
    : given_(std::move(axes)), axes_(given_), reach_(reach), tolerance_(tolerance) {}

bool AxisPattern::are_parallel(std::size_t i, std::size_t j) const {
  return axes_.angle(i, j) <= tolerance_;
}

bool AxisPattern::is_on(const Vector3d& point, std::size_t i) const {
  return axes_.distance(i, point) <= tolerance_ * reach_;
}

bool AxisPattern::meet(std::size_t i, std::size_t j) const {
  return axes_.angle(i, j) > kClearlyNotParallel && is_on(axes_.middle(i, j), j);
}

bool AxisPattern::three_meet(std::size_t i) const {
  return meet(i, i + 1) && meet(i + 1, i + 2) && is_on(axes_.middle(i, i + 1), i + 2);
}

void AxisPattern::join(std::size_t i, std::size_t more) {
  const Vector3d middle = axes_.middle(i, i + 1);
  for (std::size_t k = i; k <= i + 1 + more; ++k) axes_.p[k] = middle;
}

void AxisPattern::align(std::size_t i, std::size_t j) {
  if (axes_.angle(i, j) <= kStructureTolerance) return;
  axes_.h[j] = axes_.h[i].dot(axes_.h[j]) < 0 ? -axes_.h[i] : axes_.h[i];
}

double AxisPattern::deviation() const {
  double sum = 0;
  for (std::size_t i = 0; i < axes_.h.size(); ++i) {
    sum += 2 * (axes_.h[i].cross(given_.h[i]).norm() + given_.distance(i, axes_.p[i]) / reach_);
  }
  return sum;
}

double AxisPattern::deviation(std::size_t i) const {
  return axes_.angle(1, 2) + axes_.distance(i + 1, axes_.p[i]) / reach_;
}

std::optional<Closure> AxisPattern::find_closure() {
  if (are_parallel(1, 2) && are_parallel(2, 3) && meet(4, 5) && !are_parallel(0, 1)) {
    align(1, 2);
    align(1, 3);
    join(4);
    return Closure::three_parallel;
  }
  if (!three_meet(3)) return std::nullopt;
  join(3, 1);
  if (are_parallel(1, 2) && !are_parallel(0, 1)) {
    align(1, 2);
    return Closure::parallel_23;
  }
  if (meet(0, 1)) {
    join(0);
    return Closure::intersect_12;
  }
  if (meet(1, 2)) {
    join(1);
    return Closure::intersect_23;
  }
  if (are_parallel(0, 1) && !are_parallel(1, 2)) {
    align(0, 1);
    return Closure::parallel_12;
  }
  return std::nullopt;
}

std::optional<Closure> AxisPattern::find_sweep() {
  if (!are_parallel(1, 2) || are_parallel(0, 1) || are_parallel(4, 5)) return std::nullopt;
  if (meet(4, 5)) {
    join(4);
    return Closure::sweep_4;
  }
  if (meet(3, 4)) {
    join(3);
    return Closure::sweep_6;
  }
  return std::nullopt;
}

}  // namespace iksel
