// SPDX-License-Identifier: BSD-3-Clause
// Limits of sums of joint values.
#include "kinematics/joint_space.hpp"

namespace iksel {

double CoupledRow::sum(const double* q) const {
  double total = 0;
  for (Eigen::Index j = 0; j < c.size(); ++j) total += c[j] * q[j];
  return total;
}

bool JointSpace::holds_coupled(const double* q) const {
  return std::all_of(coupled.begin(), coupled.end(), [&](const CoupledRow& row) {
    const double sum = row.sum(q);
    return sum >= row.lower && sum <= row.upper;
  });
}

namespace {

/// How far the rows, and the joints of which images were chosen, lie outside.
double beyond_at(const JointSpace& joints, const double* q) {
  double beyond = -kInfinity;
  for (const CoupledRow& row : joints.coupled) beyond = std::max(beyond, row.beyond(row.sum(q)));
  for (const int j : joints.coupled_turning) {
    beyond = std::max({beyond, joints.lower[j] - q[j], q[j] - joints.upper[j]});
  }
  return beyond;
}

/// Calls visit(q, beyond) with q at each combination of images of the joints in coupled limits.
template <typename Visit>
void visit_images(const JointSpace& joints, const double* from, const Visit& visit) {
  const JointVector middle = joints.middle();
  JointVector q = Eigen::Map<const Eigen::VectorXd>(from, joints.dof());
  for (const JointVector& turns : joints.coupled_images) {
    for (const int j : joints.coupled_turning) {
      q[j] = from[j] + kTwoPi * (std::round((middle[j] - from[j]) / kTwoPi) + turns[j]);
    }
    visit(q, beyond_at(joints, q.data()));
  }
}

}  // namespace

double JointSpace::beyond_coupled(const double* q) const {
  if (coupled_turning.empty()) return beyond_at(*this, q);
  double least = kInfinity;
  visit_images(*this, q,
               [&](const JointVector& /*at*/, double beyond) { least = std::min(least, beyond); });
  return least;
}

void JointSpace::turn_coupled(double slack, bool takes_any, const Length& length,
                              JointVector& q) const {
  const JointVector from = q;
  double least_beyond = kInfinity;
  double shortest = kInfinity;
  visit_images(*this, from.data(), [&](const JointVector& at, double beyond) {
    if (beyond > slack && !takes_any) return;
    const double outside = beyond > slack ? beyond : 0.0;
    const double way = length(at);
    if (outside > least_beyond || (outside == least_beyond && way >= shortest)) return;
    least_beyond = outside;
    shortest = way;
    q = at;
  });
}

namespace {

/// Moves q along a row's coefficients until its sum lies inside, with the joints that come to their
/// limits on the way left there. True if it moved.
bool hold_row(const JointSpace& joints, const CoupledRow& row, JointVector& q) {
  bool moved = false;
  // Each round but the last brings a joint to its limit.
  for (int round = 0; round <= joints.dof(); ++round) {
    const double sum = row.sum(q.data());
    double excess = 0;
    if (sum > row.upper) excess = sum - (row.upper - row.rounding);
    if (sum < row.lower) excess = sum - (row.lower + row.rounding);
    if (excess == 0) return moved;
    double norm2 = 0;
    for (int j = 0; j < joints.dof(); ++j) {
      const bool goes_up = excess * row.c[j] < 0;
      const bool is_free = goes_up ? q[j] < joints.upper[j] : q[j] > joints.lower[j];
      if (is_free) norm2 += row.c[j] * row.c[j];
    }
    if (norm2 == 0) return moved;
    for (int j = 0; j < joints.dof(); ++j) {
      if (row.c[j] == 0) continue;
      const double to = q[j] - excess / norm2 * row.c[j];
      q[j] = std::min(std::max(to, joints.lower[j]), joints.upper[j]);
    }
    moved = true;
  }
  return moved;
}

}  // namespace

void JointSpace::hold_coupled(JointVector& q) const {
  // Onto one after the other leads to where all hold, if slowly where they meet at a small angle.
  constexpr int kRounds = 32;
  for (int round = 0; round < kRounds; ++round) {
    bool moved = false;
    for (const CoupledRow& row : coupled) moved = hold_row(*this, row, q) || moved;
    if (!moved) return;
  }
  // What is left, on the way to what lies inside.
  double part = 1;
  for (const CoupledRow& row : coupled) {
    const double from = row.sum(interior.data());
    const double to = row.sum(q.data());
    if (to > row.upper) part = std::min(part, (row.upper - row.rounding - from) / (to - from));
    if (to < row.lower) part = std::min(part, (row.lower + row.rounding - from) / (to - from));
  }
  if (part < 1) q = interior + part * (q - interior);
}

CoupledNormals JointSpace::coupled_normals(const JointVector& q, JointVector pull,
                                           const JointVector& free) const {
  /// Rows nearly along others, as far as their free joints go, hold nothing more.
  constexpr double kAlong = 1e-6;
  CoupledNormals normals(dof(), 0);
  for (const CoupledRow& row : coupled) {
    const double sum = row.sum(q.data());
    const double beside = 1e3 * row.rounding;
    const double slope = row.c.dot(pull);
    const bool leaves =
        (slope > 0 && sum >= row.upper - beside) || (slope < 0 && sum <= row.lower + beside);
    if (!leaves) continue;
    JointVector normal = row.c.cwiseProduct(free);
    normal -= JointVector(normals * (normals.transpose() * normal));
    const double length = normal.norm();
    if (!(length > kAlong * row.c.norm())) continue;
    normal /= length;
    pull -= normal.dot(pull) * normal;
    normals.conservativeResize(Eigen::NoChange, normals.cols() + 1);
    normals.col(normals.cols() - 1) = normal;
  }
  return normals;
}

void JointSpace::sample_coupled(Random& random, JointVector& q) const {
  constexpr int kDraws = 1000;
  for (int draw = 0; draw < kDraws; ++draw) {
    for (int j = 0; j < dof(); ++j) q[j] = random.uniform(sample_lower(j), sample_upper(j));
    if (holds_coupled(q.data())) return;
  }
  // Where so little of the box lies inside: from there one joint after the other, uniform between
  // where the others let it be (Gibbs sampling).
  constexpr int kSweeps = 32;
  q = interior;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int j = 0; j < dof(); ++j) {
      double low = sample_lower(j);
      double high = sample_upper(j);
      for (const CoupledRow& row : coupled) {
        if (row.c[j] == 0) continue;
        const double others = row.sum(q.data()) - row.c[j] * q[j];
        const double a = (row.lower + row.rounding - others) / row.c[j];
        const double b = (row.upper - row.rounding - others) / row.c[j];
        low = std::max(low, std::min(a, b));
        high = std::min(high, std::max(a, b));
      }
      if (low < high) q[j] = random.uniform(low, high);
    }
  }
}

}  // namespace iksel
