// SPDX-License-Identifier: BSD-3-Clause
#include "kinematics/joint_space.hpp"

#include "base/pace.hpp"

namespace iksel {

namespace {

/// Calls visit(q, beyond) with q at each combination of images of the joints that turn in sums, and
/// how far sums, by what a joint would have to move, and these joints lie outside there.
template <typename Visit>
void visit_turned(const JointSpace& joints, const JointVector& from, const Visit& visit) {
  const JointVector middle = joints.middle();
  JointVector q = from;
  for (const JointVector& turns : joints.images) {
    double beyond = -kInfinity;
    for (const int j : joints.turning) {
      q[j] = from[j] + kTwoPi * (std::round((middle[j] - from[j]) / kTwoPi) + turns[j]);
      beyond = std::max({beyond, joints.lower[j] - q[j], q[j] - joints.upper[j]});
    }
    for (const Limit& sum : joints.sums) {
      beyond = std::max(beyond, sum.beyond(sum.value(q.data())) / sum.size);
    }
    visit(q, beyond);
  }
}

/// Moves q along a row's coefficients until its sum lies inside, with the joints that come to their
/// limits on the way left there. True if it moved.
bool hold_row(const JointSpace& limits, const Limit& row, JointVector& q) {
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

Limit JointSpace::limit(int joint, int coupled_limit) const {
  Limit found{};
  visit_limits([&](const Limit& each) {
    if (each.joint == joint && each.coupled_limit == coupled_limit) found = each;
  });
  return found;
}

bool JointSpace::contains(const double* q) const {
  for (int j = 0; j < dof(); ++j) {
    // Written so that NaN is outside.
    if (!(q[j] >= lower[j] && q[j] <= upper[j])) return false;
  }
  return sums.empty() || contains_sums(q);
}

JointVector JointSpace::middle() const {
  JointVector middle(dof());
  for (int j = 0; j < dof(); ++j) {
    const double m = (lower[j] + upper[j]) / 2;
    middle[j] = std::isfinite(m) ? m : 0.0;
  }
  return middle;
}

void JointSpace::hold_sums(JointVector& q) const {
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

void JointSpace::add_active_sums(const JointVector& q, JointVector& pull, ActiveLimits& at) const {
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
    // Rows nearly along others, as far as their free joints go, hold nothing more.
    if (!(length > 1e-6 * row.c.norm())) continue;
    normal /= length;
    pull -= normal.dot(pull) * normal;
    across.conservativeResize(Eigen::NoChange, across.cols() + 1);
    across.col(across.cols() - 1) = normal;
  }
}

bool JointSpace::leaves(const double* q, const double* step) const {
  JointVector end(dof());
  for (int j = 0; j < dof(); ++j) {
    end[j] = q[j] + step[j];
    if ((end[j] < lower[j] || end[j] > upper[j]) && !is_periodic(j)) return true;
  }
  if (sums.empty()) return false;
  bool leaves = true;
  visit_turned(*this, end,
               [&](const JointVector& /*at*/, double beyond) { leaves = leaves && beyond > 0; });
  return leaves;
}

JointVector JointSpace::turned_to_middle(JointVector q) const {
  const JointVector to = middle();
  for (int j = 0; j < dof(); ++j) {
    if (repeats[static_cast<std::size_t>(j)]) {
      q[j] += kTwoPi * std::round((to[j] - q[j]) / kTwoPi);
    }
  }
  return q;
}

void JointSpace::choose_images(double slack, const Length& length, JointVector& q) const {
  const JointVector from = q;
  double least_beyond = kInfinity;
  double shortest = kInfinity;
  visit_turned(*this, from, [&](const JointVector& at, double beyond) {
    const double outside = beyond > slack ? beyond : 0.0;
    const double way = length(at);
    if (outside > least_beyond || (outside == least_beyond && way >= shortest)) return;
    least_beyond = outside;
    shortest = way;
    q = at;
  });
}

void JointSpace::wrap(double* q) const {
  for (int j = 0; j < dof(); ++j) {
    if (!repeats[static_cast<std::size_t>(j)]) continue;
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
  if (turning.empty() || contains_sums(q)) return;
  JointVector image = Eigen::Map<const Eigen::VectorXd>(q, dof());
  const JointVector from = image;
  choose_images(
      0, [&](const JointVector& at) { return (at - from).norm(); }, image);
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
    if (!is_periodic(j) || turns_in_sum(j)) continue;
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
  if (turning.empty()) return held;
  choose_images(
      slack, [&](const JointVector& at) { return length(at - near); }, q);
  const JointVector image = q;
  q = clamp(image);
  return held || q != image;
}

double JointSpace::lowest_image(int joint, double value) const {
  const bool ends = std::isfinite(upper[joint]);
  const double low = ends ? lower[joint] - kSameAnswer : -kPi;
  double image = value - kTwoPi * std::floor((value - low) / kTwoPi);
  if (image < low) image += kTwoPi;
  return image > upper[joint] + kSameAnswer ? value : image;
}

bool JointSpace::next_combination(JointVector& q) const {
  for (int j = 0; j < dof(); ++j) {
    // A joint without limits has no end of images; one stands for all.
    if (!is_periodic(j) || !std::isfinite(upper[j])) continue;
    if (q[j] + kTwoPi <= upper[j] + kSameAnswer) {
      q[j] += kTwoPi;
      return true;
    }
    q[j] = lowest_image(j, q[j]);
  }
  return false;
}

JointVector JointSpace::longest_moves(double dt) const {
  if (dt == 0) return JointVector::Constant(dof(), kInfinity);
  // A little more, so that a joint may run at its limit in spite of rounding.
  return velocity * (dt * (1 + 1e-9));
}

JointVector JointSpace::sample(Random& random) const {
  JointVector q(dof());
  for (int draw = 0; draw <= kMostDraws; ++draw) {
    for (int j = 0; j < dof(); ++j) q[j] = random.uniform(sample_lower(j), sample_upper(j));
    if (sums.empty() || contains_sums(q.data())) return q;
  }
  // Where so little of the box lies inside: from there one joint after the other, uniform between
  // where the others let it be (Gibbs sampling).
  q = interior;
  for (int sweep = 0; sweep < 32; ++sweep) {
    for (int j = 0; j < dof(); ++j) {
      double low = sample_lower(j);
      double high = sample_upper(j);
      for (const Limit& row : sums) {
        if (row.c[j] == 0) continue;
        const double others = row.value(q.data()) - row.c[j] * q[j];
        const double a = (row.held_at(false) - others) / row.c[j];
        const double b = (row.held_at(true) - others) / row.c[j];
        low = std::max(low, std::min(a, b));
        high = std::min(high, std::max(a, b));
      }
      if (low < high) q[j] = random.uniform(low, high);
    }
  }
  return q;
}

Matrix JointSpace::samples(std::size_t n, std::uint64_t seed, const Progress& progress) const {
  Matrix q(static_cast<Eigen::Index>(n), dof());
  Random random(seed);
  Pace pace(progress, n);
  for (std::size_t row = 0; row < n; ++row) {
    if (row % 1024 == 0) pace(row);  // the clock takes as long as a row
    q.row(static_cast<Eigen::Index>(row)) = sample(random).transpose();
  }
  return q;
}

}  // namespace iksel
