// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics/limit_set.hpp"

#include <cmath>

namespace iksel {

double Limit::sum(const double* q) const {
  double total = 0;
  for (Eigen::Index j = 0; j < c.size(); ++j) total += c[j] * q[j];
  return total;
}

bool contain(const std::vector<Limit>& limits, const double* q) {
  // Written so that NaN is outside.
  return std::all_of(limits.begin(), limits.end(),
                     [&](const Limit& limit) { return limit.beyond(limit.value(q)) <= 0; });
}

Limit LimitSet::limit(int joint, int coupled_limit) const {
  Limit found{};
  visit_limits([&](const Limit& each) {
    if (each.joint == joint && each.coupled_limit == coupled_limit) found = each;
  });
  return found;
}

bool LimitSet::contains(const double* q) const {
  for (int j = 0; j < dof(); ++j) {
    // Written so that NaN is outside.
    if (!(q[j] >= lower[j] && q[j] <= upper[j])) return false;
  }
  return sums.empty() || contains_sums(q);
}

JointVector LimitSet::middle() const {
  JointVector middle(dof());
  for (int j = 0; j < dof(); ++j) {
    const double m = (lower[j] + upper[j]) / 2;
    middle[j] = std::isfinite(m) ? m : 0.0;
  }
  return middle;
}

namespace {

/// Moves q along a row's coefficients until its sum lies inside, with the joints that come to their
/// limits on the way left there. True if it moved.
bool hold_row(const LimitSet& limits, const Limit& row, JointVector& q) {
  bool moved = false;
  // Each round but the last brings a joint to its limit.
  for (int round = 0; round <= limits.dof(); ++round) {
    const double sum = row.value(q.data());
    if (row.beyond(sum) <= 0) return moved;
    const double excess = sum - row.held_at(/*at_upper=*/sum > row.upper);
    double norm2 = 0;
    for (int j = 0; j < limits.dof(); ++j) {
      const bool goes_up = excess * row.c[j] < 0;
      const bool is_free = goes_up ? q[j] < limits.upper[j] : q[j] > limits.lower[j];
      if (is_free) norm2 += row.c[j] * row.c[j];
    }
    if (norm2 == 0) return moved;
    q = (q - excess / norm2 * row.c).cwiseMax(limits.lower).cwiseMin(limits.upper);
    moved = true;
  }
  return moved;
}

}  // namespace

void LimitSet::hold_sums(JointVector& q) const {
  // Onto one after the other leads to where all hold, if slowly where they meet at a small angle.
  for (int round = 0; round < 32; ++round) {
    bool moved = false;
    for (const Limit& row : sums) moved = hold_row(*this, row, q) || moved;
    if (!moved) return;
  }
  // What is left, on the way to what lies inside.
  double part = 1;
  for (const Limit& row : sums) {
    const double from = row.value(interior.data());
    const double to = row.value(q.data());
    if (row.beyond(to) <= 0) continue;
    part = std::min(part, (row.held_at(/*at_upper=*/to > row.upper) - from) / (to - from));
  }
  if (part < 1) q = interior + part * (q - interior);
}

void LimitSet::add_active_sums(const JointVector& q, JointVector& pull, ActiveLimits& at) const {
  /// Rows nearly along others, as far as their free joints go, hold nothing more.
  constexpr double kAlong = 1e-6;
  auto& across = at.across;
  across.resize(dof(), 0);
  for (const Limit& row : sums) {
    const double sum = row.value(q.data());
    const double beside = 1e3 * row.rounding;
    const double slope = row.c.dot(pull);
    const bool leaves =
        (slope > 0 && sum >= row.upper - beside) || (slope < 0 && sum <= row.lower + beside);
    if (!leaves) continue;
    JointVector normal = row.c.cwiseProduct(at.free);
    normal -= JointVector(across * (across.transpose() * normal));
    const double length = normal.norm();
    if (!(length > kAlong * row.c.norm())) continue;
    normal /= length;
    pull -= normal.dot(pull) * normal;
    across.conservativeResize(Eigen::NoChange, across.cols() + 1);
    across.col(across.cols() - 1) = normal;
  }
}

}  // namespace iksel
