// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/closest_screen.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace iksel {
namespace {

/// How far seeds go, all at first, and how many packs of the best of them are left: these once more
/// at the end, which shows whether they have come to rest.
struct ScreenRound {
  int iterations;
  int packs;
};
constexpr ScreenRound kScreenRounds[] = {{5, 3}, {12, 1}, {12, 1}, {4, 1}};

}  // namespace

ClosestScreen::ClosestScreen(const ChainModel& model, std::uint64_t seed,
                             const lanes::LaneKernels& kernels)
    : model_(model),
      kernels_(kernels),
      base_inverse_(to_pose(model.kernel.base).inverse()),
      last_to_tcp_(to_pose(model.kernel.flange) * Pose(model.tcp)),
      chain_(make_lane_chain<float>(model, length_)),
      seed_(seed) {
  const auto pack = static_cast<std::size_t>(model.dof * lanes::kBlock);
  random_.resize(kRandomPacks * pack);
  packs_.resize(kPacks * pack);
  kept_.resize(kPacks * pack);
  targets_.reserve(kPacks);
  kept_targets_.reserve(kPacks);
  seeds_.reserve(kPacks * lanes::kBlock);
  Random random(seed);
  for (int i = 0; i < kRandomPacks; ++i) {
    for (int place = 0; place < lanes::kBlock; ++place) {
      const JointVector q = model.joints.sample(random);
      for (int j = 0; j < model.dof; ++j) row(random_, i, j)[place] = static_cast<float>(q[j]);
    }
  }
}

void ClosestScreen::use_length(const Vector6& squares) {
  const double position = std::sqrt(squares.head<3>().maxCoeff());
  const double rotation = std::sqrt(squares.tail<3>().maxCoeff());
  const bool counts = position > 0 && rotation > 0;
  // Beyond, single precision has nothing left of the smaller one.
  const double length = counts ? std::clamp(rotation / position, 1e-3, 1e3) : 1.0;
  if (length == length_) return;
  length_ = length;
  chain_ = make_lane_chain<float>(model_, length);
}

void ClosestScreen::add_target(const Pose& allowed, const Goal& goal, const Vector6& squares) {
  const bool in_tool = goal.task().task().frame == TaskFrame::tool;
  const Eigen::Matrix3d from_base = base_inverse_.linear();
  const Eigen::Matrix3d axes =
      in_tool ? Eigen::Matrix3d(from_base * goal.target().linear()) : from_base;
  const double rotation2 = squares.tail<3>().maxCoeff();
  // All that is measured, in units of the rotation's largest weight, or else of the position's.
  const double unit2 = rotation2 > 0 ? rotation2 : squares.head<3>().maxCoeff();
  const Eigen::Matrix3d metric = axes * squares.head<3>().asDiagonal() * axes.transpose();
  Eigen::Matrix3d traced = Eigen::Matrix3d::Identity();
  if (rotation2 > 0) {
    // 1 - E_xx is half the sum of the squares of rotations about the other two, to second order.
    const Eigen::Vector3d turns = squares.tail<3>() / rotation2;
    traced = (Eigen::Vector3d::Constant(turns.sum()) - 2 * turns).asDiagonal();
  }
  const Eigen::Matrix3d back = allowed.linear().transpose();
  const Eigen::Matrix3d B =
      last_to_tcp_.linear() * (in_tool ? traced * back : back * traced) * from_base.transpose();
  const Eigen::Vector3d position = base_inverse_ * Eigen::Vector3d(allowed.translation());
  lanes::ClosestTarget target{};
  for (int i = 0; i < 3; ++i) {
    target.position[i] = static_cast<float>(position[i] / length_);
    target.tcp[i] = static_cast<float>(last_to_tcp_.translation()[i] / length_);
    for (int k = 0; k < 3; ++k) {
      target.metric[i][k] = static_cast<float>(metric(i, k) * length_ * length_ / unit2);
      target.rotation[i][k] = static_cast<float>(B(i, k));
    }
  }
  target.trace = static_cast<float>(traced.trace());
  target.rotation2 = rotation2 > 0 ? 1 : 0;
  targets_.push_back(target);
}

int ClosestScreen::load_seeds(LaneQuery& query) {
  int packs = 0;
  const auto load = [&](const auto& values) {
    for (int j = 0; j < chain_.n; ++j) {
      const float* from = values(j);
      float* to = row(packs_, packs, j);
      std::transform(from, from + lanes::kBlock, to,
                     [&](float value) { return chain_.to_lane(j, value); });
    }
    ++packs;
  };
  const lanes::SeedPack& near = query.packs[0];
  query.prepare_leaf();
  load([&](int j) { return near.q[j]; });
  query.begin_blocks();
  if (query.next_blocks(1) > 0) load([&](int j) { return near.q[j]; });
  for (int i = 0; i < kRandomPacks; ++i) {
    load([&](int j) { return row(random_, i, j); });
  }
  return packs;
}

void ClosestScreen::move(int packs, int iterations) {
  seeds_.resize(static_cast<std::size_t>(packs * lanes::kBlock));
  for (int pack = 0; pack < packs; ++pack) {
    float remainder[lanes::kBlock];
    kernels_.approach(chain_, targets_[static_cast<std::size_t>(pack)], iterations,
                      row(packs_, pack, 0), remainder);
    for (int place = 0; place < lanes::kBlock; ++place) {
      const int i = pack * lanes::kBlock + place;
      Seed& seed = seeds_[static_cast<std::size_t>(i)];
      seed = {remainder[place], seed.remainder - remainder[place], i};
    }
  }
}

void ClosestScreen::keep(int packs) {
  const auto is_less = [](const Seed& a, const Seed& b) {
    return a.remainder < b.remainder || (a.remainder == b.remainder && a.place < b.place);
  };
  // Less work than a partial sort, as most are kept or few are.
  const auto kept = seeds_.begin() + packs * lanes::kBlock;
  std::nth_element(seeds_.begin(), kept, seeds_.end(), is_less);
  std::sort(seeds_.begin(), kept, is_less);
  kept_targets_.clear();
  for (int i = 0; i < packs * lanes::kBlock; ++i) {
    const int from = seeds_[static_cast<std::size_t>(i)].place;
    const int pack = from / lanes::kBlock;
    // A pack is of one target, which is that of its best seed.
    if (i % lanes::kBlock == 0) {
      kept_targets_.push_back(targets_[static_cast<std::size_t>(pack)]);
    }
    for (int j = 0; j < chain_.n; ++j) {
      row(kept_, i / lanes::kBlock, j)[i % lanes::kBlock] =
          row(packs_, pack, j)[from % lanes::kBlock];
    }
  }
  packs_.swap(kept_);
  targets_.swap(kept_targets_);
}

void ClosestScreen::find(const Goal& goal, const Vector6& weights, LaneQuery& query) {
  const Vector6 counts = goal.task().without_free(weights).cwiseAbs2();
  const int twist = goal.task().twist_axis();
  const bool counts_twist = twist >= 0 && counts[3 + twist] > 0;
  // A trace has the squares of rotations that weigh unlike to second order only.
  const auto turns = counts.tail<3>();
  is_measured_ =
      !counts_twist && turns.sum() == (twist < 0 ? 3 : 2) * turns.maxCoeff() &&
      (counts.array() == 0 || goal.task().lower().array() == goal.task().upper().array()).all();
  use_length(counts);
  query.set_target(query.reduce(goal.nearest_pose()));
  int packs = load_seeds(query);
  targets_.clear();
  add_target(goal.nearest_pose(), goal, counts);
  Random random(seed_);
  while (static_cast<int>(targets_.size()) < packs) {
    if (goal.is_full_pose()) {
      targets_.push_back(targets_.front());
    } else {
      add_target(goal.random_pose(random), goal, counts);
    }
  }
  seeds_.assign(static_cast<std::size_t>(packs * lanes::kBlock),
                {static_cast<float>(kInfinity), 0, 0});
  for (const ScreenRound& round : kScreenRounds) {
    move(packs, round.iterations);
    packs = round.packs;
    keep(packs);
  }
}

JointVector ClosestScreen::q(int i) const {
  JointVector q(chain_.n);
  for (int j = 0; j < chain_.n; ++j) {
    const float value = packs_[static_cast<std::size_t>(j * lanes::kBlock + i)];
    q[j] = chain_.from_lane(j, static_cast<double>(value));
  }
  model_.joints.wrap(q.data());
  return model_.joints.clamp(q);
}

}  // namespace iksel
