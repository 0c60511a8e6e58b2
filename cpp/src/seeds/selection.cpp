// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/selection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.hpp"
#include "base/pseudo_inverse.hpp"
#include "base/rotation.hpp"
#include "database/key.hpp"
#include "simd/kernels.hpp"

namespace iksel {

Selection::Selection(const ChainModel* model, const ChainModel* nominal, const DatabaseData& data,
                     const Paper& scheme)
    : model_(model),
      nominal_(nominal),
      data_(data),
      scheme_(scheme),
      chain_{},
      neighbours_(std::min<std::size_t>(static_cast<std::size_t>(scheme.neighbours), data.size)),
      queue_(data.dof, scheme, neighbours_.size()) {
  if (data.reduction) {
    chain_ = make_lane_chain(*nominal);
    seeds_.resize(neighbours_.size() * static_cast<std::size_t>(data.dof));
  }
}

std::size_t Selection::nearest_seeds(const Pose& T_base_flange, std::size_t k) {
  query(T_base_flange, k);
  if (data_.reduction) prepare_seeds();
  return found_;
}

void Selection::query(const Pose& T_base_flange, std::size_t k) {
  target_ = data_.reduction ? data_.reduction->reduce(T_base_flange) : T_base_flange;
  Eigen::Map<Eigen::Vector3d> position(target_x_);
  Eigen::Map<Eigen::Vector3d> rotation(target_x_ + 3);
  position = target_.translation();
  rotation = to_rotation_vector(target_.linear());
  double key[kMaxKeyDimension];
  data_.make_key(T_base_flange, key);
  found_ = data_.tree->nearest(key, std::min(k, neighbours_.size()), neighbours_.data());
  if (scheme_.neighbour_radius > 0) drop_far_neighbours();
}

void Selection::drop_far_neighbours() {
  const double most = scheme_.neighbour_radius * scheme_.neighbour_radius;
  const auto end =
      std::remove_if(neighbours_.begin(), neighbours_.begin() + static_cast<std::ptrdiff_t>(found_),
                     [&](const Neighbour& each) { return each.distance > most; });
  found_ = static_cast<std::size_t>(end - neighbours_.begin());
}

void Selection::rank() {
  if (data_.reduction) prepare_seeds();
  queue_.clear(found_);
  for (std::size_t i = 0; i < found_; ++i) {
    Candidate candidate{neighbours_[i].distance, neighbours_[i].index,
                        static_cast<std::uint32_t>(i), false};
    if (scheme_.ranking == Ranking::joint_adjustment || scheme_.limit_aware) score(candidate);
    queue_.push(candidate);
  }
  queue_.sort(static_cast<std::size_t>(scheme_.candidates));
}

void Selection::prepare_seeds() {
  const lanes::SeedChain chain = make_seed_chain(*nominal_, *data_.reduction);
  const lanes::SeedTarget target = make_seed_target(target_);
  const auto dof = static_cast<std::size_t>(data_.dof);
  float block[lanes::block_rows(kMaxDof) * lanes::kBlock];
  lanes::SeedPack pack;
  std::size_t kept = 0;
  for (std::size_t first = 0; first < found_; first += lanes::kBlock) {
    const std::size_t count = std::min<std::size_t>(lanes::kBlock, found_ - first);
    for (std::size_t s = 0; s < lanes::kBlock; ++s) {
      write_to_block(data_, neighbours_[first + std::min(s, count - 1)].index, static_cast<int>(s),
                     block);
    }
    lanes::kKernelsScalar.prepare(chain, target, block, pack);
    for (std::size_t s = 0; s < count; ++s) {
      double* q = &seeds_[kept * dof];
      std::copy_n(data_.q(neighbours_[first + s].index), dof, q);
      if (data_.reduction->leaves_out(0)) q[0] = static_cast<double>(pack.first[s]);
      if (data_.reduction->leaves_out(data_.dof - 1)) {
        q[dof - 1] = static_cast<double>(pack.last[s]);
      }
      if (!model_->joints.contains(q)) continue;
      neighbours_[kept] = neighbours_[first + s];
      ++kept;
    }
  }
  found_ = kept;
}

const double* Selection::seed_of(const Candidate& candidate) const {
  return data_.reduction ? &seeds_[candidate.place * static_cast<std::size_t>(data_.dof)]
                         : data_.q(candidate.index);
}

Vector6 Selection::error_of(const Candidate& candidate) const {
  const double* x = data_.x(candidate.index);
  Vector6 e = Eigen::Map<const Vector6>(target_x_) - Eigen::Map<const Vector6>(x);
  const bool geodesic = scheme_.rotation_difference == RotationDifference::geodesic;
  if (!geodesic && !data_.reduction) return e;
  // A reduced sample has its first and last joint at zero: the target is brought there too.
  const Pose target =
      data_.reduction ? data_.reduction->without_outer_joints(target_, chain_, seed_of(candidate))
                      : target_;
  const Eigen::Matrix3d R = from_rotation_vector(Eigen::Map<const Eigen::Vector3d>(x + 3));
  e.head<3>() = target.translation() - Eigen::Map<const Eigen::Vector3d>(x);
  e.tail<3>() = geodesic ? to_rotation_vector(target.linear() * R.transpose())
                         : Eigen::Vector3d(to_rotation_vector(target.linear()) -
                                           Eigen::Map<const Eigen::Vector3d>(x + 3));
  return e;
}

JointVector Selection::adjustment(const Candidate& candidate) const {
  const Vector6 e = error_of(candidate);
  const double* pseudo_inverse = data_.pseudo_inverse(candidate.index);
  const int dof = data_.dof;
  JointVector adjustment(dof);
  for (int i = 0; i < dof; ++i) adjustment[i] = pseudo_inverse[i] * e[0];
  for (int j = 1; j < 6; ++j) {
    const double* column = pseudo_inverse + j * dof;
    for (int i = 0; i < dof; ++i) adjustment[i] += column[i] * e[j];
  }
  return adjustment;
}

void Selection::score(Candidate& candidate) const {
  const JointVector predicted = adjustment(candidate);
  if (scheme_.ranking == Ranking::joint_adjustment) {
    const double sum = square(predicted);
    // Not a number has no place in an order.
    candidate.score = std::isnan(sum) ? kInfinity : sum;
  }
  candidate.leaves_limits =
      scheme_.limit_aware && model_->joints.leaves(seed_of(candidate), predicted.data());
}

}  // namespace iksel
