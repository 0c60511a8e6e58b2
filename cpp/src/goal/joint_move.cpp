// SPDX-License-Identifier: BSD-3-Clause
#include "goal/joint_move.hpp"

#include <algorithm>
#include <cmath>

namespace iksel {

JointVector weights_of_time(const JointVector& longest) {
  double most = 0;
  for (const double step : longest) most = std::isfinite(step) ? std::max(most, step) : most;
  return longest.cwiseMin(most).cwiseInverse();
}

std::optional<NearestTo> find_nearest_to(int dof, const SolveRequest& request) {
  // Of the largest weight. The joints with weight give way by its square only, which does not
  // matter: the others move by some radians.
  constexpr double kDecides = 1e-5;
  const Objective& objective = request.objective;
  if (!objective.is_set()) {
    if (!request.near) return std::nullopt;
    return NearestTo{*request.near, JointMove(dof, request)};
  }
  if (objective.kind != Objective::Kind::posture) return std::nullopt;
  JointVector from = objective.posture;
  JointVector weights = weights_or_ones(objective.weights, dof);
  const double deciding = kDecides * weights.maxCoeff();
  for (int j = 0; j < dof; ++j) {
    if (weights[j] > 0) continue;
    weights[j] = deciding;
    if (!request.near) continue;
    from[j] = (*request.near)[j];
    if (request.weights.size() > 0) weights[j] *= request.weights[j] / request.weights.maxCoeff();
  }
  return NearestTo{std::move(from), JointMove(std::move(weights))};
}

MoveCost::MoveCost(const JointVector& weights, const JointVector& from, double power)
    : from_(from), power_(power) {
  weights_ = weights.cwiseMax(kLeastWeight * weights.maxCoeff());
}

double MoveCost::operator()(const JointVector& q, JointVector* gradient,
                            JointVector* curvature) const {
  const JointVector d = weights_.cwiseProduct(q - from_);
  const double largest = d.cwiseAbs().maxCoeff();
  if (power_ == 2 || largest == 0) {
    if (gradient != nullptr) *gradient = weights_.cwiseProduct(d);
    if (curvature != nullptr) *curvature = weights_.cwiseAbs2();
    return 0.5 * d.squaredNorm();
  }
  // (sum |d|^p)^(1/p), scaled by the largest against overflow. The curvature leaves out the rank
  // one part, and is bounded below to stay positive where d is 0.
  const JointVector r = d.cwiseAbs() / largest;
  const double sum = r.array().pow(power_).sum();
  const double value = largest * std::pow(sum, 1 / power_);
  const double scale = std::pow(sum, 1 / power_ - 1);
  for (Eigen::Index j = 0; j < d.size(); ++j) {
    const double slope = scale * std::pow(r[j], power_ - 1);
    if (gradient != nullptr) (*gradient)[j] = weights_[j] * std::copysign(slope, d[j]);
    if (curvature != nullptr) {
      constexpr double kFloor = 1e-3;
      (*curvature)[j] = weights_[j] * weights_[j] * (power_ - 1) / largest *
                        std::max(scale * std::pow(r[j], power_ - 2), kFloor);
    }
  }
  return value;
}

}  // namespace iksel
