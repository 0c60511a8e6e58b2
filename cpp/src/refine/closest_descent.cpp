// SPDX-License-Identifier: BSD-3-Clause
#include "refine/closest_descent.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "refine/least_cost_step.hpp"

namespace iksel {
namespace {

/// Leaves out what would leave limits that q stands at. With sums a joint that pulls beyond its
/// limit may come back as a sum is held: then the step chooses what to hold, and H is only made
/// steep there, which changes nothing along the limits.
void hold_at_limits(const JointSpace& joints, const JointVector& q, JointVector& gradient,
                    SquareMatrix& H) {
  const ActiveLimits at = joints.active(q, -gradient, [](int /*joint*/) { return true; });
  if (!joints.sums.empty()) {
    constexpr double kSteep = 10;
    const double steep = kSteep * H.diagonal().cwiseAbs().maxCoeff();
    H.diagonal() += steep * (JointVector::Ones(q.size()) - at.free);
    H += steep * at.across * at.across.transpose();
    return;
  }
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    if (at.free[j] != 0) continue;
    gradient[j] = 0;
    H.row(j).setZero();
    H.col(j).setZero();
    H(j, j) = 1;
  }
}

/// The step -H^-1 g inside the limits: joints that it would take beyond go to their limits, and the
/// others do what is best then. False if H is not positive.
bool step_inside(const JointSpace& joints, const JointVector& q, const JointVector& gradient,
                 SquareMatrix H, JointVector& step) {
  if (!joints.sums.empty()) {
    if (Eigen::LLT<SquareMatrix>(H).info() != Eigen::Success) return false;
    step = LeastCostStep<Eigen::Dynamic, kMaxCoupledLimits, SquareMatrix>(joints, q, gradient, H)
               .solve();
    return true;
  }
  JointVector right = -gradient;
  bool held[kMaxDof] = {};
  for (bool changed = true; changed;) {
    const Eigen::LLT<SquareMatrix> factors(H);
    if (factors.info() != Eigen::Success) return false;
    step = factors.solve(right);
    changed = false;
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const double goal = std::clamp(q[j] + step[j], joints.lower[j], joints.upper[j]);
      if (held[j] || goal == q[j] + step[j]) continue;
      held[j] = changed = true;
      right -= H.col(j) * (goal - q[j]);
      right[j] = goal - q[j];
      H.row(j).setZero();
      H.col(j).setZero();
      H(j, j) = 1;
    }
  }
  return true;
}

/// The remainder at a point, where joints that would leave their limits are held.
struct Slope {
  double value;
  const JointVector& gradient;
  const JointVector& diagonal;  ///< as of Remainder::value
  const SquareMatrix& H;
};

/// A step of Newton's method from q that lowers the remainder, damped as it must be: false if there
/// is none.
bool step_down(const Remainder& remainder, const Slope& at, double& damping, JointVector& q) {
  constexpr double kNothing = 1e-14;
  constexpr double kLeastDamping = 1e-10;
  constexpr double kMostDamping = 1e6;
  const JointSpace& joints = remainder.goal().joints();
  const JointVector scale = at.diagonal.array() + 1e-6 * at.diagonal.maxCoeff() + 1e-12;
  // Nothing to be gained, even along directions in which it is nearly flat.
  const double gain = 0.5 * at.gradient.cwiseAbs2().cwiseQuotient(scale).sum();
  if (gain <= kNothing * at.value) return false;
  for (; damping <= kMostDamping; damping *= 10) {
    SquareMatrix damped = at.H;
    damped.diagonal() += damping * scale;
    JointVector step;
    if (!step_inside(joints, q, at.gradient, damped, step)) continue;
    if (!joints.sums.empty() && -0.5 * at.gradient.dot(step) <= kNothing * at.value) return false;
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > kLongestStep) step *= kLongestStep / longest;
    const JointVector next = joints.clamp(q + step);
    if (!(remainder.value(next) < at.value)) continue;
    q = next;
    damping = std::max(damping * 1e-3, kLeastDamping);
    return true;
  }
  return false;
}

/// A direction v of length 1 along which H is negative; false if there is none. If the first rows
/// of H are positive, but not with row k, then it is that which these leave of joint k.
bool find_falling(const SquareMatrix& H, JointVector& v) {
  constexpr double kFlat = 1e-6;
  // Mostly H is positive, which one factorisation tells.
  if (Eigen::LLT<SquareMatrix>(H).info() == Eigen::Success) return false;
  for (Eigen::Index k = 0; k < H.rows(); ++k) {
    const SquareMatrix with = H.topLeftCorner(k + 1, k + 1);
    if (Eigen::LLT<SquareMatrix>(with).info() == Eigen::Success) continue;
    v.setZero(H.rows());
    v[k] = 1;
    if (k > 0) {
      const SquareMatrix before = H.topLeftCorner(k, k);
      const JointVector column = H.col(k).head(k);
      v.head(k) = -Eigen::LLT<SquareMatrix>(before).solve(column);
    }
    v.normalize();
    return v.dot(H * v) < -kFlat * H.diagonal().cwiseAbs().maxCoeff();
  }
  return false;
}

/// Leaves a point where the gradient is nothing, but the remainder falls to both sides: an arm
/// stretched out towards a target that has come back within reach. Goes to the side of the middle
/// of the limits, if it falls there. False if there is no such side.
bool leave_saddle(const Remainder& remainder, const Slope& at, JointVector& q) {
  constexpr double kWorthIt = 1e-3;
  const JointSpace& joints = remainder.goal().joints();
  JointVector side;
  if (!find_falling(at.H, side)) return false;
  if (side.dot(joints.middle() - q) < 0) side = -side;
  for (const double length : {0.1, 0.01, 0.001}) {
    for (const double sign : {1.0, -1.0}) {
      const JointVector next = joints.clamp(q + sign * length * side);
      if (!(remainder.value(next) < at.value * (1 - kWorthIt))) continue;
      q = next;
      return true;
    }
  }
  return false;
}

}  // namespace

double descend_to_closest(const Remainder& remainder, int most, JointVector& q, int& steps,
                          double best) {
  JointVector gradient(q.size());
  JointVector diagonal(q.size());
  SquareMatrix H;
  double value = 0;
  const auto look = [&] {
    value = remainder.value(q, gradient, diagonal, &H);
    hold_at_limits(remainder.goal().joints(), q, gradient, H);
  };
  look();
  double damping = 1e-4;
  for (int taken = 0; taken < most; ++taken) {
    const JointVector from = q;
    const bool is_lower = step_down(remainder, {value, gradient, diagonal, H}, damping, q);
    const double before = value;
    if (is_lower) look();
    const bool is_settled = !is_lower || before - value <= kRounding * value ||
                            (q - from).cwiseAbs().maxCoeff() < kRounding;
    if (is_settled) {
      if (!leave_saddle(remainder, {value, gradient, diagonal, H}, q)) return value;
      look();
    }
    ++steps;
    if (taken > 0 && value - kHopefulSteps * (before - value) > best) return value;
  }
  return value;
}

double descend_from_seed(const Remainder& remainder, int most, JointVector& q, int& steps,
                         double best) {
  const JointSpace& joints = remainder.goal().joints();
  q = joints.clamp(q);
  const double value = descend_to_closest(remainder, most, q, steps, best);
  // Whole turns matter only to joints that follow the one that took them.
  JointVector principal = q;
  joints.wrap(principal.data());
  if (principal == q) return value;
  if (remainder.value(principal) <= value * (1 + kRounding) + kRounding * kRounding) q = principal;
  return value;
}

}  // namespace iksel
