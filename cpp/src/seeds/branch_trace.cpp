// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/branch_trace.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "simd/branch_kernel.hpp"

namespace iksel {
namespace {

using lanes::Closure;

/// A quality of the kernel (branch_math.hpp) that remembers the first root of less than 0.
struct Trace {
  double error;  ///< as ClosedForm::error
  int calls = 0;
  int failed = -1;
  double square = 0;

  void divide_by_product(double /*product*/) {}
  void take_root(double at, double near, double /*root*/) {
    if (failed < 0 && at < -2 * error * near) {
      failed = calls;
      square = at;
    }
    ++calls;
  }
};

/// The joints whose angles take a root, in the kernel's order.
std::array<int, 3> joints_by_call(Closure closure) {
  switch (closure) {
    case Closure::parallel_23:
      return {0, 2, 4};
    case Closure::intersect_12:
      return {2, 0, 4};
    case Closure::intersect_23:
      return {0, 2, 4};
    case Closure::parallel_12:
      return {2, 1, 4};
    case Closure::three_parallel:
      return {0, 4, 2};
    case Closure::sweep_4:
    case Closure::sweep_6:
    case Closure::loop:
      break;
  }
  return {};
}

bool bends_elbow(Closure closure) {
  return closure == Closure::parallel_23 || closure == Closure::intersect_12 ||
         closure == Closure::three_parallel;
}

/// What the elbow was asked for, from the angle nearest to it that the kernel gave.
ElbowSpan span_of(const ClosedFormChain& chain, const lanes::Angle<double>& q3, double square) {
  const lanes::ClosedForm& form = chain.form;
  const lanes::Turned& elbow = form.elbow;
  const bool parallel = form.closure != Closure::intersect_12;
  const double turns_back = form.closure == Closure::three_parallel ? form.side3 : 1.0;
  const double side = elbow.a * q3.c + elbow.b * turns_back * q3.s < 0 ? -1 : 1;
  const double off = side * std::sqrt(std::max(elbow.r2 - square, 0.0));
  const double radius = std::sqrt(elbow.r2);
  // What lies along parallel axes is always there and counts for nothing.
  double along = 0;
  if (parallel) {
    for (int i = 0; i < 3; ++i) along += form.h[1][i] * (form.p[1][i] + form.p[2][i]);
  }
  const auto distance = [&](double dot) {
    const double square_of_it = form.arm2 + 2 * (elbow.c + dot) - along * along;
    return chain.unit * std::sqrt(std::max(square_of_it, 0.0));
  };
  return {distance(off), distance(-radius), distance(radius)};
}

}  // namespace

MissingAngle find_missing_angle(const ClosedFormChain& chain, const lanes::BranchPack& pack,
                                int lane) {
  const lanes::ClosedForm& form = chain.form;
  const auto vector = [&](int i) {
    return lanes::Vec<double>{pack.target[i][lane], pack.target[i + 1][lane],
                              pack.target[i + 2][lane]};
  };
  const lanes::BranchTarget<double> target{vector(0), vector(3), vector(6), vector(9)};
  const double sign[3] = {pack.sign[0][lane], pack.sign[1][lane], pack.sign[2][lane]};
  lanes::Branch<double, Trace> branch;
  branch.quality = Trace{form.error};
  if (form.closure == Closure::three_parallel) {
    lanes::solve_three_parallel(form, target, sign, branch);
  } else {
    lanes::place_wrist(form, target.w, sign, branch);
    lanes::turn_wrist(form, lanes::behind_arm(form, target, branch), sign[2], branch);
  }
  const Trace& trace = branch.quality;
  if (trace.failed < 0) return {};
  MissingAngle missing;
  missing.found = trace.failed;
  missing.joint = joints_by_call(form.closure)[static_cast<std::size_t>(trace.failed)];
  missing.square = trace.square;
  missing.is_elbow = missing.joint == 2 && bends_elbow(form.closure);
  if (missing.is_elbow) missing.span = span_of(chain, branch.q[2], trace.square);
  return missing;
}

}  // namespace iksel
