// SPDX-License-Identifier: BSD-3-Clause
#include "goal/objective_cost.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "base/symmetric.hpp"
#include "goal/joint_move.hpp"
#include "iksel/error.hpp"

namespace iksel {

double manipulability(const RobotModel& model, const JointVector& q) {
  const Jacobians rows = model.jacobians(q.data());
  if (model.tip_count() > 1) {
    const Eigen::MatrixXd gram = rows.rows() <= rows.cols()
                                     ? Eigen::MatrixXd(rows * rows.transpose())
                                     : rows.transpose() * rows;
    return std::sqrt(std::max(gram.determinant(), 0.0));
  }
  const Jacobian J = rows;
  // With fewer joints than six, of J^T J, filled up by the identity.
  double gram[6][6] = {};
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      if (model.dof >= 6) {
        gram[i][k] = J.row(i).dot(J.row(k));
      } else if (std::max(i, k) < model.dof) {
        gram[i][k] = J.col(i).dot(J.col(k));
      } else {
        gram[i][k] = i == k ? 1 : 0;
      }
    }
  }
  const double square = SymmetricFactors<double>(gram, 0.0).determinant();
  return square > 0 ? std::sqrt(square) : 0;
}

double ObjectiveCost::of_posture(const JointVector& q, JointVector* gradient,
                                 JointVector* curvature) const {
  const JointVector weights = weights_or_ones(objective_.weights, model_.dof);
  return MoveCost(weights, objective_.posture)(q, gradient, curvature);
}

namespace {

/// Of both ends of a range, 1 in its middle.
struct Repulsion {
  double cost, slope, curvature;

  Repulsion(double above_lower, double range) {
    // Nearer than this part of the range a limit repels no more than there, so that the cost stays
    // finite; it goes on in a straight line, so that the way off a limit is down.
    constexpr double kNearest = 1e-4;
    const double x = std::min(std::max(above_lower / range, kNearest), 1 - kNearest);
    const double below = 1 / x;
    const double above = 1 / (1 - x);
    slope = 0.25 * (above * above - below * below) / range;
    cost = 0.25 * (below + above) + slope * (above_lower - x * range);
    curvature = 0.5 * (below * below * below + above * above * above) / (range * range);
  }
};

}  // namespace

double ObjectiveCost::of_limits(const JointVector& q, JointVector* gradient,
                                JointVector* curvature) const {
  if (gradient != nullptr) gradient->setZero(model_.dof);
  if (curvature != nullptr) curvature->setZero(model_.dof);
  double sum = 0;
  model_.joints.visit_limits([&](const Limit& limit) {
    const double range = limit.upper - limit.lower;
    if (!(std::isfinite(range) && range > 0)) return;
    const Repulsion at(limit.value(q.data()) - limit.lower, range);
    sum += at.cost;
    const JointVector c = limit.row(model_.dof);
    if (gradient != nullptr) *gradient += at.slope * c;
    // c c^T is no more than its rows' sums of sizes on the diagonal.
    if (curvature != nullptr) *curvature += at.curvature * limit.size * c.cwiseAbs();
  });
  // Joints without limits have a little, so that they do not drift; and of what one at its limit
  // has as much as rounding leaves of a step's equations.
  if (curvature != nullptr) {
    *curvature = curvature->cwiseMax(std::max(1e-8 * curvature->maxCoeff(), 1e-6));
  }
  return sum;
}

double ObjectiveCost::of_custom(const JointVector& q) const {
  const double cost = objective_.cost(q);
  if (cost > -kInfinity) return cost;
  MessageStream text;
  text << "objective: the cost is " << cost << " at q = ["
       << q.transpose().format(Eigen::IOFormat(6, 0, ", ", ", "))
       << "]; it has to be a number, or +infinity where q must not be";
  throw InvalidArgumentError(text.str());
}

JointVector ObjectiveCost::slope(const JointVector& q) const {
  if (objective_.kind == Objective::Kind::custom && objective_.gradient) {
    JointVector given = objective_.gradient(q);
    check_joints(given, model_.dof, "objective gradient");
    return given;
  }
  constexpr double kStep = 1e-5;
  JointVector gradient(model_.dof);
  for (int j = 0; j < model_.dof; ++j) {
    // One-sided at a limit, beyond which a cost need not be defined.
    JointVector above = q;
    JointVector below = q;
    above[j] = std::min(q[j] + kStep, model_.joints.upper[j]);
    below[j] = std::max(q[j] - kStep, model_.joints.lower[j]);
    const double width = above[j] - below[j];
    const double difference = width > 0 ? value(above) - value(below) : 0.0;
    // Beside a place where the cost is infinite the difference says nothing.
    gradient[j] = std::isfinite(difference) && width > 0 ? difference / width : 0.0;
  }
  return gradient;
}

double ObjectiveCost::estimate_curvature(const JointVector& q, const JointVector& gradient) const {
  // The first step is as long as this [rad or m].
  constexpr double kFirst = 0.2;
  double curvature = gradient.norm() / kFirst;
  if (last_q_.size() != 0) {
    const JointVector dq = q - last_q_;
    const double along = dq.dot(gradient - last_gradient_);
    // Where the cost is concave a step as long as may be is right: the descent bounds it.
    curvature = along > 0 ? along / dq.squaredNorm() : 0.5 * last_curvature_;
  }
  last_q_ = q;
  last_gradient_ = gradient;
  last_curvature_ = std::max(curvature, 1e-12);
  return last_curvature_;
}

double ObjectiveCost::operator()(const JointVector& q, JointVector* gradient,
                                 JointVector* curvature) const {
  switch (objective_.kind) {
    case Objective::Kind::none:
      return 0;
    case Objective::Kind::posture:
      return of_posture(q, gradient, curvature);
    case Objective::Kind::limits:
      return of_limits(q, gradient, curvature);
    case Objective::Kind::manipulability:
    case Objective::Kind::custom:
      break;
  }
  if (gradient != nullptr) {
    *gradient = slope(q);
    if (curvature != nullptr) {
      curvature->setConstant(model_.dof, estimate_curvature(q, *gradient));
    }
  }
  return objective_.kind == Objective::Kind::custom ? of_custom(q) : -manipulability(model_, q);
}

}  // namespace iksel
