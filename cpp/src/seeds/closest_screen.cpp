// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/closest_screen.hpp"

#include <algorithm>
#include <utility>

#include "simd/lane_chain.hpp"

namespace iksel {
namespace {

/// Packs of seeds: from the database besides the nearest leaf, and at random.
constexpr int kBlocksForClosest = 3;
constexpr int kRandomPacks = 12;
constexpr int kFirstIterations = 5;
/// Packs that go on, and how far.
struct ScreenRound {
  int packs;
  int iterations;
};
constexpr ScreenRound kScreenRounds[] = {{4, 8}, {1, 12}};

/// The length that 1 rad counts [m].
double length_of(const Vector6& weights) {
  constexpr double kLeast = 1e-3;
  constexpr double kMost = 1e3;
  const double position = weights.head<3>().maxCoeff();
  const double rotation = weights.tail<3>().maxCoeff();
  if (!(position > 0) || !(rotation > 0)) return 1;
  return std::clamp(rotation / position, kLeast, kMost);
}

}  // namespace

ClosestScreen::ClosestScreen(const ChainModel& model, const Vector6& weights)
    : model_(model),
      approach_(lanes::choose_kernels().approach),
      length_(length_of(weights)),
      position_(weights.head<3>().maxCoeff() > 0 ? 1 : 0),
      rotation_(weights.tail<3>().maxCoeff() > 0 ? 1 : 0),
      chain_(make_rough_chain(model)) {
  const auto shrink = static_cast<float>(1 / length_);
  for (int j = 0; j < chain_.n; ++j) {
    auto& joint = chain_.joint[j];
    for (float& p : joint.p) p *= shrink;
    if (!joint.prismatic) continue;
    for (float* slide : {&joint.offset, &joint.lower, &joint.upper}) *slide *= shrink;
  }
}

template <typename Value>
void ClosestScreen::load(int place, const Value& value) {
  for (int j = 0; j < chain_.n; ++j) {
    const auto q = static_cast<double>(value(j));
    pack_.q[j][place] = static_cast<float>(chain_.joint[j].prismatic ? q / length_ : q);
  }
}

void ClosestScreen::run(std::size_t target, int iterations) {
  const Pose& Y = targets_[target];
  for (int row = 0; row < lanes::kFullPoseRows; ++row) {
    const double value = Y(row % 3, (row / 3 + 3) % 4);
    pack_.target[row] = static_cast<float>(row < 3 ? value / length_ : value);
  }
  approach_(chain_, position_, rotation_, iterations, pack_);
  for (int place = 0; place < lanes::kBlock; ++place) {
    const auto number = static_cast<unsigned>(joints_.size() / static_cast<std::size_t>(chain_.n));
    seeds_.push_back({pack_.error2[place], number, static_cast<unsigned>(target)});
    for (int j = 0; j < chain_.n; ++j) joints_.push_back(pack_.q[j][place]);
  }
}

void ClosestScreen::keep(std::size_t count) {
  count = std::min(count, seeds_.size());
  const auto is_less = [](const Seed& a, const Seed& b) {
    return a.remainder < b.remainder || (a.remainder == b.remainder && a.number < b.number);
  };
  std::partial_sort(seeds_.begin(), seeds_.begin() + static_cast<std::ptrdiff_t>(count),
                    seeds_.end(), is_less);
  seeds_.resize(count);
}

int ClosestScreen::count() { return (1 + kBlocksForClosest + kRandomPacks) * lanes::kBlock; }

const std::vector<JointVector>& ClosestScreen::find(const Goal& goal, LaneQuery& query,
                                                    Random& random) {
  targets_.assign(1, query.reduce(goal.nearest_pose()));
  seeds_.clear();
  joints_.clear();
  query.set_target(targets_[0]);
  const auto run_block = [&](const lanes::SeedPack& block) {
    for (int place = 0; place < lanes::kBlock; ++place) {
      load(place, [&](int j) { return static_cast<double>(block.q[j][place]); });
    }
    run(0, kFirstIterations);
  };
  query.prepare_leaf(query.packs[0]);
  run_block(query.packs[0]);
  const int blocks = std::min(kBlocksForClosest, static_cast<int>(query.measure_blocks()));
  query.prepare_blocks(0, static_cast<std::size_t>(blocks), query.packs);
  for (int i = 0; i < blocks; ++i) run_block(query.packs[i]);
  double q[kMaxDof];
  for (int i = 0; i < kRandomPacks; ++i) {
    for (int place = 0; place < lanes::kBlock; ++place) {
      model_.joints.sample(random, q);
      load(place, [&](int j) { return q[j]; });
    }
    if (!goal.is_full_pose()) targets_.push_back(query.reduce(goal.random_pose(random)));
    run(targets_.size() - 1, kFirstIterations);
  }
  for (const ScreenRound& round : kScreenRounds) {
    keep(static_cast<std::size_t>(round.packs) * lanes::kBlock);
    go_on(round.iterations);
  }
  keep(seeds_.size());
  found_.clear();
  for (const Seed& seed : seeds_) found_.push_back(joints_of(seed));
  return found_;
}

void ClosestScreen::go_on(int iterations) {
  const std::vector<Seed> from = std::exchange(seeds_, {});
  for (std::size_t begin = 0; begin < from.size(); begin += lanes::kBlock) {
    for (int place = 0; place < lanes::kBlock; ++place) {
      const Seed& seed = from[std::min(begin + static_cast<std::size_t>(place), from.size() - 1)];
      for (int j = 0; j < chain_.n; ++j) pack_.q[j][place] = values_of(seed)[j];
    }
    run(from[begin].target, iterations);
  }
}

JointVector ClosestScreen::joints_of(const Seed& seed) const {
  JointVector q(chain_.n);
  for (int j = 0; j < chain_.n; ++j) {
    const auto value = static_cast<double>(values_of(seed)[j]);
    q[j] = chain_.joint[j].prismatic ? value * length_ : value;
  }
  model_.joints.wrap(q.data());
  return model_.joints.clamp(q);
}

}  // namespace iksel
