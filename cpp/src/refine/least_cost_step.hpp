// SPDX-License-Identifier: BSD-3-Clause
// The step along a self-motion that makes a cost least.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/pseudo_inverse.hpp"
#include "kinematics/joint_space.hpp"

namespace iksel {

/// The step that makes a cost least to second order (gradient g, second derivative H) inside the
/// bounds of a goal's rows, those of sums A q and the joint limits: min 1/2 s^T H s + g^T s under
/// lower <= [J s; A s; s] <= upper. By the primal active-set method (Nocedal and Wright: "Numerical
/// Optimization", 2006, section 16.5), whose steps are solved for in the rows of J and A only.
/// `kRows`: 6, or dynamic. `Curvature`: H's diagonal, or all of a positive H.
template <int kRows, int kMostRows, typename Curvature = JointVector>
class LeastCostStep {
 public:
  /// From q, around which the goal is linear; all must outlive this.
  template <typename Linear>
  LeastCostStep(const JointSpace& joints, const JointVector& q, const Linear& at,
                const JointVector& gradient, const Curvature& curvature)
      : LeastCostStep(joints, q, gradient, curvature, static_cast<int>(at.J.rows())) {
    const auto of_goal = static_cast<int>(at.J.rows());
    J_.topRows(of_goal) = at.J;
    row_lower_.head(of_goal) = at.lower - at.deviation;
    row_upper_.head(of_goal) = at.upper - at.deviation;
    for (int i = 0; i < of_goal; ++i) {
      fixed_[i] = at.is_fixed(i);
      row_side_[i] = fixed_[i] ? 1 : 0;
    }
  }

  /// Inside the limits only, before `of_goal` rows of a goal are set.
  LeastCostStep(const JointSpace& joints, const JointVector& q, const JointVector& gradient,
                const Curvature& curvature, int of_goal = 0)
      : gradient_(gradient),
        curvature_(curvature),
        dof_(joints.dof()),
        rows_(of_goal + static_cast<int>(joints.sums.size())) {
    J_.resize(rows_, dof_);
    row_lower_.resize(rows_);
    row_upper_.resize(rows_);
    for (int i = of_goal; i < rows_; ++i) {
      const Limit& row = joints.sums[static_cast<std::size_t>(i - of_goal)];
      const double sum = row.value(q.data());
      J_.row(i) = row.c.transpose();
      row_lower_[i] = row.held_at(false) - sum;
      row_upper_[i] = row.held_at(true) - sum;
      fixed_[i] = false;
      row_side_[i] = 0;
    }
    lower_ = joints.lower - q;
    upper_ = joints.upper - q;
    side_.setZero(dof_);
  }

  JointVector solve() {
    JointVector x = JointVector::Zero(dof_);
    for (int round = 0; round < 4 * (dof_ + rows_); ++round) {
      RowVector y;
      const JointVector slope = curve(x) + gradient_;
      const JointVector p = step_on_active(slope, y);
      if (advance(p, x)) continue;
      // At the least cost over the active bounds, whose multipliers are y.
      if (!release(slope + curve(p), y)) break;
    }
    return x;
  }

 private:
  using Rows = Eigen::Matrix<double, kRows, Eigen::Dynamic, Eigen::ColMajor, kMostRows, kMaxDof>;
  using RowVector = Eigen::Matrix<double, kRows, 1, Eigen::ColMajor, kMostRows, 1>;

  [[nodiscard]] JointVector curve(const JointVector& x) const {
    if constexpr (Curvature::IsVectorAtCompileTime) {
      return curvature_.cwiseProduct(x);
    } else {
      return curvature_ * x;
    }
  }

  /// The inverse of H over the joints that are not held, 0 for the others.
  [[nodiscard]] auto inverse_of_free() const {
    if constexpr (Curvature::IsVectorAtCompileTime) {
      return Eigen::DiagonalMatrix<double, Eigen::Dynamic, kMaxDof>(
          (side_.array() == 0).select(curvature_.cwiseInverse(), JointVector::Zero(dof_)));
    } else {
      const JointVector free = (side_.array() == 0).template cast<double>();
      Curvature H = free.asDiagonal() * curvature_ * free.asDiagonal();
      H.diagonal() += JointVector::Ones(dof_) - free;
      const Curvature solved = H.llt().solve(Curvature::Identity(dof_, dof_));
      return Curvature(free.asDiagonal() * solved * free.asDiagonal());
    }
  }

  /// The step from x to the least cost over the directions that the active bounds leave.
  JointVector step_on_active(const JointVector& slope, RowVector& y) const {
    Rows rows = J_;
    for (int i = 0; i < rows_; ++i) {
      if (row_side_[i] == 0) rows.row(i).setZero();
    }
    const auto inverse = inverse_of_free();
    const Rows weighted = rows * inverse;
    Eigen::Matrix<double, kRows, kRows, Eigen::ColMajor, kMostRows, kMostRows> A =
        weighted * rows.transpose();
    A.diagonal().array() += 1e-12 * std::max(A.trace(), 1e-12);
    if constexpr (kRows == 6) {
      y = solve_symmetric(A, weighted * slope);
    } else {
      y = A.ldlt().solve(weighted * slope);
    }
    return inverse * JointVector(rows.transpose() * y - slope);
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
  const Curvature& curvature_;
  int dof_;
  int rows_;
  RowVector row_lower_, row_upper_;
  JointVector lower_, upper_;
  bool fixed_[kMostRows];
  /// Which bound is active: -1 the lower, 1 the upper, 0 none.
  int row_side_[kMostRows];
  JointVector side_;
};

/// That step, whatever the number of rows.
template <typename Linear>
JointVector least_cost_step(const JointSpace& joints, const JointVector& q, const Linear& at,
                            const JointVector& gradient, const JointVector& curvature) {
  using Vector = typename Linear::Vector;
  if constexpr (Vector::RowsAtCompileTime != Eigen::Dynamic) {
    using Step = LeastCostStep<Vector::RowsAtCompileTime, Vector::MaxRowsAtCompileTime>;
    if (joints.sums.empty()) return Step(joints, q, at, gradient, curvature).solve();
  }
  constexpr int kMost = Vector::MaxRowsAtCompileTime + kMaxCoupledLimits;
  return LeastCostStep<Eigen::Dynamic, kMost>(joints, q, at, gradient, curvature).solve();
}

}  // namespace iksel
