// SPDX-License-Identifier: BSD-3-Clause
#include "structure/axis_pattern.hpp"

#include <utility>

#include "structure/closed_form.hpp"

namespace iksel {
namespace {

using Eigen::Vector3d;
using lanes::Closure;

/// Axes at a smaller angle are neither parallel nor can it be said where they meet [rad].
constexpr double kClearlyNot = 1e-3;

}  // namespace

AxisPattern::AxisPattern(ScrewAxes axes, double reach, double tolerance)
    : given_(std::move(axes)), axes_(given_), reach_(reach), tolerance_(tolerance) {}

bool AxisPattern::are_parallel(std::size_t i, std::size_t j) const {
  return axes_.angle(i, j) <= tolerance_;
}

bool AxisPattern::is_on(const Vector3d& point, std::size_t i) const {
  return axes_.distance(i, point) <= tolerance_ * reach_;
}

bool AxisPattern::meet(std::size_t i, std::size_t j) const {
  return axes_.angle(i, j) > kClearlyNot && is_on(axes_.middle(i, j), j);
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
