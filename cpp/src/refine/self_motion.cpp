// SPDX-License-Identifier: BSD-3-Clause
#include "refine/self_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "options/strategy.hpp"
#include "refine/iterate.hpp"
#include "refine/schemes.hpp"

namespace iksel {
namespace {

/// The step that makes a cost least to second order (gradient g, diagonal second derivative H)
/// inside the joint limits, the coupled ones A q and the task's box: min 1/2 s^T H s + g^T s under
/// lower <= [J s; A s; s] <= upper. By the primal active-set method (Nocedal and Wright: "Numerical
/// Optimization", 2006, section 16.5), whose steps are solved for in the rows of J and A only.
/// `kRows`: 6, or dynamic if there is an A.
template <int kRows>
class SelfMotionStep {
 public:
  SelfMotionStep(const ChainModel& model, const TaskSpace& task, const JointVector& q,
                 const Vector6& d, const JacobianMatrix& J, const JointVector& gradient,
                 const JointVector& curvature)
      : gradient_(gradient), curvature_(curvature), dof_(model.dof) {
    const std::vector<CoupledRow>& coupled = model.joints.coupled;
    rows_ = 6 + static_cast<int>(coupled.size());
    J_.resize(rows_, dof_);
    row_lower_.resize(rows_);
    row_upper_.resize(rows_);
    J_.template topRows<6>() = J;
    row_lower_.template head<6>() = task.aim_lower() - d;
    row_upper_.template head<6>() = task.aim_upper() - d;
    for (int i = 6; i < rows_; ++i) {
      const CoupledRow& row = coupled[static_cast<std::size_t>(i - 6)];
      const double sum = row.sum(q.data());
      J_.row(i) = row.c.transpose();
      row_lower_[i] = row.lower + row.rounding - sum;
      row_upper_[i] = row.upper - row.rounding - sum;
    }
    lower_ = model.joints.lower - q;
    upper_ = model.joints.upper - q;
    for (int i = 0; i < rows_; ++i) {
      fixed_[i] = i < 6 && task.lower()[i] == task.upper()[i];
      row_side_[i] = fixed_[i] ? 1 : 0;
    }
    side_.setZero(dof_);
  }

  JointVector solve() {
    JointVector x = JointVector::Zero(dof_);
    for (int round = 0; round < 4 * (dof_ + rows_); ++round) {
      RowVector y;
      const JointVector slope = curvature_.cwiseProduct(x) + gradient_;
      const JointVector p = step_on_active(slope, y);
      if (advance(p, x)) continue;
      // At the least cost over the active bounds, whose multipliers are y.
      if (!release(slope + curvature_.cwiseProduct(p), y)) break;
    }
    return x;
  }

 private:
  static constexpr int kMostRows = kRows == 6 ? 6 : 6 + kMaxCoupledLimits;
  using Rows = Eigen::Matrix<double, kRows, Eigen::Dynamic, Eigen::ColMajor, kMostRows, kMaxDof>;
  using RowVector = Eigen::Matrix<double, kRows, 1, Eigen::ColMajor, kMostRows, 1>;

  /// The step from x to the least cost over the directions that the active bounds leave.
  JointVector step_on_active(const JointVector& slope, RowVector& y) const {
    Rows rows = J_;
    for (int i = 0; i < rows_; ++i) {
      if (row_side_[i] == 0) rows.row(i).setZero();
    }
    const JointVector inverse =
        (side_.array() == 0).select(curvature_.cwiseInverse(), JointVector::Zero(dof_));
    const Rows weighted = rows * inverse.asDiagonal();
    Eigen::Matrix<double, kRows, kRows, Eigen::ColMajor, kMostRows, kMostRows> A =
        weighted * rows.transpose();
    A.diagonal().array() += 1e-12 * std::max(A.trace(), 1e-12);
    if constexpr (kRows == 6) {
      y = solve_symmetric(A, weighted * slope);
    } else {
      y = A.ldlt().solve(weighted * slope);
    }
    return inverse.cwiseProduct(rows.transpose() * y - slope);
  }

  /// Goes from x along p to its end, or to the first bound on the way, which becomes active. True
  /// if there was one.
  bool advance(const JointVector& p, JointVector& x) {
    double part = 1;
    int joint = -1;
    int row = -1;
    const auto look = [&](double at, double rate, double low, double high) {
      constexpr double kSlow = 1e-14;
      if (std::abs(rate) < kSlow) return false;
      const double room = std::max((rate > 0 ? high - at : low - at) / rate, 0.0);
      if (room >= part) return false;
      part = room;
      return true;
    };
    for (int j = 0; j < dof_; ++j) {
      if (side_[j] == 0 && look(x[j], p[j], lower_[j], upper_[j])) joint = j;
    }
    const RowVector at = J_ * x;
    const RowVector rate = J_ * p;
    for (int i = 0; i < rows_; ++i) {
      if (row_side_[i] == 0 && look(at[i], rate[i], row_lower_[i], row_upper_[i])) row = i;
    }
    x += part * p;
    if (row >= 0) {
      row_side_[row] = rate[row] > 0 ? 1 : -1;
    } else if (joint >= 0) {
      side_[joint] = p[joint] > 0 ? 1 : -1;
    }
    return row >= 0 || joint >= 0;
  }

  /// Takes out the active bound whose multiplier says most that it pulls instead of holding; false
  /// if there is none.
  bool release(const JointVector& slope, const RowVector& y) {
    double most = 1e-12;
    int joint = -1;
    int row = -1;
    const JointVector rest = J_.transpose() * active(y) - slope;
    for (int j = 0; j < dof_; ++j) {
      if (side_[j] == 0 || -side_[j] * rest[j] <= most) continue;
      most = -side_[j] * rest[j];
      joint = j;
    }
    for (int i = 0; i < rows_; ++i) {
      if (fixed_[i] || row_side_[i] == 0 || row_side_[i] * y[i] <= most) continue;
      most = row_side_[i] * y[i];
      row = i;
    }
    if (row >= 0) {
      row_side_[row] = 0;
    } else if (joint >= 0) {
      side_[joint] = 0;
    }
    return row >= 0 || joint >= 0;
  }

  [[nodiscard]] RowVector active(const RowVector& y) const {
    RowVector out = y;
    for (int i = 0; i < rows_; ++i) {
      if (row_side_[i] == 0) out[i] = 0;
    }
    return out;
  }

  Rows J_;
  const JointVector& gradient_;
  const JointVector& curvature_;
  int dof_;
  int rows_;
  RowVector row_lower_, row_upper_;
  JointVector lower_, upper_;
  bool fixed_[kMostRows];
  /// Which bound is active: -1 the lower, 1 the upper, 0 none.
  int row_side_[kMostRows];
  JointVector side_;
};

}  // namespace

bool converge(const ChainModel& model, const Goal& goal, int most, JointVector& q, int& steps) {
  // The default scheme, whatever that of the solver is.
  Paper scheme = one_at_a_time(Lanes{});
  scheme.whole_turns = false;
  Random unused(0);
  IterationContext context{model, scheme, most, goal, goal.target(), nullptr, unused};
  context.aim = 0.01;
  context.steps_at_tcp = true;
  return iterate(context, q, steps) == Outcome::solved;
}

int descend_self_motion(const ChainModel& model, const Goal& goal, const JointCost& cost, int most,
                        JointVector& q) {
  /// Longest step of a joint, within which the pose stays near enough to be corrected [rad or m].
  constexpr double kLongest = 0.5;
  constexpr double kSettled = 1e-7;
  constexpr int kCorrections = 8;
  JointVector gradient(model.dof);
  JointVector curvature(model.dof);
  Pose pose;
  Jacobian of_pose;
  double value = cost(q, &gradient, &curvature);
  int steps = 0;
  while (steps < most) {
    model.fk_jacobian(q.data(), pose, of_pose);
    JacobianMatrix J = of_pose;
    const Vector6 d = goal.task().deviation(goal.target(), pose, J);
    const JointVector step =
        model.joints.coupled.empty()
            ? SelfMotionStep<6>(model, goal.task(), q, d, J, gradient, curvature).solve()
            : SelfMotionStep<Eigen::Dynamic>(model, goal.task(), q, d, J, gradient, curvature)
                  .solve();
    const double longest = step.cwiseAbs().maxCoeff();
    if (!(longest > kSettled)) return steps;
    double scale = std::min(1.0, kLongest / longest);
    bool better = false;
    for (int halving = 0; halving < 8 && !better; ++halving, scale /= 2) {
      JointVector next = model.joints.clamp(q + scale * step);
      if (!converge(model, goal, kCorrections, next)) continue;
      const double next_value = cost(next, nullptr, nullptr);
      if (!(next_value < value)) continue;
      better = true;
      q = next;
    }
    ++steps;
    if (!better) return steps;
    value = cost(q, &gradient, &curvature);
  }
  return steps;
}

int descend_to_near(const ChainModel& model, const Goal& goal, const JointMove& move,
                    const JointVector& near, JointVector& q) {
  constexpr int kSteps = 20;
  int steps = 0;
  const auto descend = [&](double power) {
    const MoveCost cost(move.weights(), near, power);
    steps += descend_self_motion(model, goal, JointCost(cost), kSteps, q);
  };
  descend(2);
  if (move.norm() == MoveNorm::two) return steps;
  JointVector best = q;
  // The p-norm tends to the max norm; each is easy to reach from the one before.
  for (const double power : {4.0, 16.0, 64.0}) {
    descend(power);
    if (move.length(q - near) < move.length(best - near)) best = q;
  }
  q = best;
  return steps;
}

}  // namespace iksel
