// SPDX-License-Identifier: BSD-3-Clause
#include "selection/selection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "database/key.hpp"
#include "math/pseudo_inverse.hpp"
#include "math/rotation.hpp"

namespace iksel {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;

}  // namespace

Selection::Selection(const ChainModel& model, const DatabaseData& data,
                     const SolverOptions& options)
    : model_(model),
      data_(data),
      options_(options),
      neighbours_(std::min<std::size_t>(static_cast<std::size_t>(options.neighbours), data.size)),
      candidates_(neighbours_.size()) {}

void Selection::query(const Pose& T_base_flange) {
  target_ = T_base_flange;
  Eigen::Map<Eigen::Vector3d> position(target_x_);
  Eigen::Map<Eigen::Vector3d> rotation(target_x_ + 3);
  position = target_.translation();
  rotation = to_rotation_vector(target_.linear());
  double key[kMaxKeyDimension];
  make_key(data_.options, target_, key);
  found_ = data_.tree.nearest(key, neighbours_.size(), neighbours_.data());
}

void Selection::rank() {
  for (std::size_t i = 0; i < found_; ++i) {
    Candidate& candidate = candidates_[i];
    candidate = {neighbours_[i].distance, neighbours_[i].index, false};
    if (options_.ranking == Ranking::joint_adjustment || options_.limit_aware) {
      score(candidate, data_.record(candidate.index));
    }
  }
  kept_ = std::min(found_, static_cast<std::size_t>(options_.candidates));
  const auto begin = candidates_.begin();
  std::partial_sort(begin, begin + static_cast<std::ptrdiff_t>(kept_),
                    begin + static_cast<std::ptrdiff_t>(found_));
  sum_of_failed_.setZero(model_.dof);
}

void Selection::score(Candidate& candidate, const double* x) const {
  // Eq. (4): the joint adjustment that the sample's own pseudo-inverse predicts.
  Vector6 e = Eigen::Map<const Vector6>(target_x_) - Eigen::Map<const Vector6>(x);
  if (options_.rotation_difference == RotationDifference::geodesic) {
    const Eigen::Matrix3d R = from_rotation_vector(Eigen::Map<const Eigen::Vector3d>(x + 3));
    e.tail<3>() = to_rotation_vector(target_.linear() * R.transpose());
  }
  const double* pseudo_inverse = data_.pseudo_inverse(candidate.index);
  double adjustment[kMaxDof];
  const int dof = model_.dof;
  for (int i = 0; i < dof; ++i) adjustment[i] = pseudo_inverse[i] * e[0];
  for (int j = 1; j < 6; ++j) {
    const double* column = pseudo_inverse + j * dof;
    for (int i = 0; i < dof; ++i) adjustment[i] += column[i] * e[j];
  }
  if (options_.ranking == Ranking::joint_adjustment) {
    double sum = 0;
    for (int i = 0; i < dof; ++i) sum += adjustment[i] * adjustment[i];
    candidate.score = sum;
  }
  if (options_.limit_aware) {
    const double* q = data_.q(candidate.index);
    for (int i = 0; i < dof; ++i) {
      const double predicted = q[i] + adjustment[i];
      // A whole turn or more of range can always be wrapped.
      if ((predicted < model_.lower[i] || predicted > model_.upper[i]) &&
          !(model_.upper[i] - model_.lower[i] >= kTwoPi &&
            model_.joint_types[static_cast<std::size_t>(i)] != JointType::prismatic)) {
        candidate.leaves_limits = true;
        return;
      }
    }
  }
}

const double* Selection::next_seed(int attempt) {
  const auto position = static_cast<std::size_t>(attempt);
  if (position >= kept_ || (attempt > 0 && options_.reselection == Reselection::none)) {
    return nullptr;
  }
  if (attempt > 0 && options_.reselection == Reselection::farthest) {
    bring_farthest_forward(attempt);
  }
  return data_.q(candidates_[position].index);
}

void Selection::bring_farthest_forward(int attempt) {
  // Of the candidates not tried yet, the one with the largest |m q - sum of the m failed q|.
  const auto dof = model_.dof;
  const auto position = static_cast<std::size_t>(attempt);
  sum_of_failed_ +=
      Eigen::Map<const Eigen::VectorXd>(data_.q(candidates_[position - 1].index), dof);
  std::size_t best = position;
  double best_distance = -1;
  for (std::size_t i = position; i < kept_; ++i) {
    const double* q = data_.q(candidates_[i].index);
    double distance = 0;
    for (int j = 0; j < dof; ++j) {
      const double d = attempt * q[j] - sum_of_failed_[j];
      distance += d * d;
    }
    if (distance > best_distance) {
      best_distance = distance;
      best = i;
    }
  }
  // The others keep their order.
  std::rotate(candidates_.begin() + static_cast<std::ptrdiff_t>(position),
              candidates_.begin() + static_cast<std::ptrdiff_t>(best),
              candidates_.begin() + static_cast<std::ptrdiff_t>(best) + 1);
}

}  // namespace iksel
