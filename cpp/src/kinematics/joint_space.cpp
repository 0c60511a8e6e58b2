// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics/joint_space.hpp"

#include "base/pace.hpp"

namespace iksel {

JointSpace::JointSpace(int dof)
    : names(static_cast<std::size_t>(dof)),
      types(static_cast<std::size_t>(dof)),
      lower(dof),
      upper(dof),
      velocity(dof) {}

bool JointSpace::contains(const double* q) const {
  for (int j = 0; j < dof(); ++j) {
    // Written so that NaN is outside.
    if (!(q[j] >= lower[j] && q[j] <= upper[j])) return false;
  }
  return coupled.empty() || holds_coupled(q);
}

bool JointSpace::leaves(const double* q, const double* step) const {
  for (int j = 0; j < dof(); ++j) {
    const double end = q[j] + step[j];
    if ((end < lower[j] || end > upper[j]) && !is_periodic(j)) return true;
  }
  if (coupled.empty()) return false;
  JointVector end(dof());
  for (int j = 0; j < dof(); ++j) end[j] = q[j] + step[j];
  return beyond_coupled(end.data()) > 0;
}

JointVector JointSpace::middle() const {
  JointVector middle(dof());
  for (int j = 0; j < dof(); ++j) {
    const double m = (lower[j] + upper[j]) / 2;
    middle[j] = std::isfinite(m) ? m : 0.0;
  }
  return middle;
}

JointVector JointSpace::turned_to_middle(JointVector q) const {
  const JointVector to = middle();
  for (int j = 0; j < dof(); ++j) {
    if (!is_slide(j)) q[j] += kTwoPi * std::round((to[j] - q[j]) / kTwoPi);
  }
  return q;
}

void JointSpace::wrap(double* q) const {
  for (int j = 0; j < dof(); ++j) {
    if (is_slide(j)) continue;
    if (type(j) == JointType::continuous) {
      // Any value is allowed; a principal one is what users expect.
      if (std::abs(q[j]) > kPi) q[j] = without_turns(q[j]);
    } else if (q[j] < lower[j]) {
      const double wrapped = q[j] + kTwoPi * std::ceil((lower[j] - q[j]) / kTwoPi);
      if (wrapped <= upper[j]) q[j] = wrapped;
    } else if (q[j] > upper[j]) {
      const double wrapped = q[j] - kTwoPi * std::ceil((q[j] - upper[j]) / kTwoPi);
      if (wrapped >= lower[j]) q[j] = wrapped;
    }
  }
  if (coupled_turning.empty() || holds_coupled(q)) return;
  JointVector image = Eigen::Map<const Eigen::VectorXd>(q, dof());
  const JointVector from = image;
  turn_coupled(
      0, /*takes_any=*/true, [&](const JointVector& at) { return (at - from).norm(); }, image);
  for (int j = 0; j < dof(); ++j) q[j] = image[j];
}

bool JointSpace::wrap_nearest(const JointVector& near, double slack, JointVector& q) const {
  return wrap_nearest(
      near, slack, [](const JointVector& d) { return d.norm(); }, q);
}

bool JointSpace::wrap_nearest(const JointVector& near, double slack, const Length& length,
                              JointVector& q) const {
  bool held = false;
  for (int j = 0; j < dof(); ++j) {
    if (!is_periodic(j) || has_coupled_images(j)) continue;
    const double low = lower[j] - slack;
    const double high = upper[j] + slack;
    double value = q[j];
    if (std::abs(near[j] - value) > kPi) value += kTwoPi * std::round((near[j] - value) / kTwoPi);
    // The nearest image of all lies outside: then the nearest inside.
    if (value > high) value -= kTwoPi * std::ceil((value - high) / kTwoPi);
    if (value < low) value += kTwoPi * std::ceil((low - value) / kTwoPi);
    if (value < low || value > high) continue;
    q[j] = std::min(std::max(value, lower[j]), upper[j]);
    held = held || q[j] != value;
  }
  if (coupled_turning.empty()) return held;
  turn_coupled(
      slack, /*takes_any=*/false, [&](const JointVector& at) { return length(at - near); }, q);
  const JointVector inside = contains(q.data()) ? q : clamp(q);
  held = held || inside != q;
  q = inside;
  return held;
}

void JointSpace::first_image(JointVector& q) const {
  lowest_image(q);
  // Of the combinations, the first that holds what is coupled.
  if (!coupled_turning.empty() && !holds_coupled(q.data())) next_image(q);
}

bool JointSpace::next_image(JointVector& q) const {
  if (coupled_turning.empty()) return next_combination(q);
  while (next_combination(q)) {
    if (holds_coupled(q.data())) return true;
  }
  if (!holds_coupled(q.data())) {
    while (next_combination(q) && !holds_coupled(q.data())) {
    }
  }
  return false;
}

void JointSpace::lowest_image(JointVector& q) const {
  for (int j = 0; j < dof(); ++j) {
    if (!is_periodic(j)) continue;
    const double low = std::isfinite(lower[j]) ? lower[j] : -kPi;
    double value = q[j] - kTwoPi * std::floor((q[j] - low) / kTwoPi);
    if (value < low) value += kTwoPi;
    if (value <= upper[j]) q[j] = value;
  }
}

bool JointSpace::next_combination(JointVector& q) const {
  for (int j = 0; j < dof(); ++j) {
    // A joint without limits has no end of images; one stands for all.
    if (!is_periodic(j) || !std::isfinite(upper[j])) continue;
    if (q[j] + kTwoPi <= upper[j]) {
      q[j] += kTwoPi;
      return true;
    }
    q[j] -= kTwoPi * std::floor((q[j] - lower[j]) / kTwoPi);
    if (q[j] < lower[j]) q[j] += kTwoPi;
  }
  return false;
}

JointVector JointSpace::longest_moves(double dt) const {
  if (dt == 0) return JointVector::Constant(dof(), kInfinity);
  // A little more, so that a joint may run at its limit in spite of rounding.
  constexpr double kSlack = 1e-9;
  return velocity * (dt * (1 + kSlack));
}

Matrix JointSpace::samples(std::size_t n, std::uint64_t seed, const Progress& progress) const {
  constexpr std::size_t kRowsBetweenTellings = 1024;
  Matrix q(static_cast<Eigen::Index>(n), dof());
  Random random(seed);
  Pace pace(progress, n);
  for (std::size_t row = 0; row < n; ++row) {
    if (row % kRowsBetweenTellings == 0) pace(row);
    sample(random, q.row(static_cast<Eigen::Index>(row)));
  }
  return q;
}

}  // namespace iksel
