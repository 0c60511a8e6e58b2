// SPDX-License-Identifier: BSD-3-Clause
#include "structure/screw_axes.hpp"

#include <algorithm>
#include <utility>

#include "structure/closed_form.hpp"

namespace iksel {

using Eigen::Vector3d;
using lanes::Closure;
using Lie = AxisRun::Lie;

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

bool AxisPattern::has(const AxisRun& run) const {
  const std::size_t last = run.first + run.count - 1;
  for (std::size_t i = run.first; i < last; ++i) {
    const bool is_so = run.lie == Lie::parallel ? are_parallel(i, i + 1)
                                                : axes_.angle(i, i + 1) > kClearlyNotParallel &&
                                                      is_on(axes_.middle(i, i + 1), i + 1);
    if (!is_so) return false;
  }
  return run.lie == Lie::parallel || is_on(axes_.middle(run.first, run.first + 1), last);
}

void AxisPattern::set_right(const AxisRun& run) {
  const Vector3d h = axes_.h[run.first];
  const Vector3d middle = axes_.middle(run.first, run.first + 1);
  for (std::size_t k = run.first; k < run.first + run.count; ++k) {
    if (run.lie == Lie::meet) {
      axes_.p[k] = middle;
    } else if (axes_.angle(run.first, k) > kStructureTolerance) {
      axes_.h[k] = h.dot(axes_.h[k]) < 0 ? -h : h;
    }
  }
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

const std::vector<AxisRule>& axis_rules() {
  static const std::vector<AxisRule> kRules = {
      {Closure::three_parallel, {{Lie::parallel, 1, 3}, {Lie::meet, 4, 2}}, {0}},
      {Closure::parallel_23, {{Lie::meet, 3, 3}, {Lie::parallel, 1, 2}}, {0}},
      {Closure::intersect_12, {{Lie::meet, 3, 3}, {Lie::meet, 0, 2}}, {}},
      {Closure::intersect_23, {{Lie::meet, 3, 3}, {Lie::meet, 1, 2}}, {}},
      {Closure::parallel_12, {{Lie::meet, 3, 3}, {Lie::parallel, 0, 2}}, {1}},
      {Closure::sweep_4, {{Lie::parallel, 1, 2}, {Lie::meet, 4, 2}}, {0}},
      {Closure::sweep_6, {{Lie::parallel, 1, 2}, {Lie::meet, 3, 2}}, {0, 4}},
  };
  return kRules;
}

std::optional<Closure> AxisPattern::find_closure(bool is_swept) {
  for (const auto& [closure, runs, bends] : axis_rules()) {
    if ((closure == Closure::sweep_4 || closure == Closure::sweep_6) != is_swept) continue;
    if (!std::all_of(runs.begin(), runs.end(), [&](const AxisRun& run) { return has(run); }) ||
        std::any_of(bends.begin(), bends.end(),
                    [&](std::size_t i) { return are_parallel(i, i + 1); })) {
      continue;
    }
    for (const AxisRun& run : runs) {
      // What is found by sweeps is refined, and how far these are from parallel is measured.
      if (run.lie == Lie::meet || !is_swept) set_right(run);
    }
    return closure;
  }
  return std::nullopt;
}

}  // namespace iksel
