// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/branch_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace iksel {
namespace {

/// A joint may go so many times as far between two nodes as from one to the other, or the next; and
/// where a branch ends is looked at closely in so many rounds, whatever its joints do (python -m
/// bench lost --random 100 --builds rail --targets 30000).
constexpr double kDetour = 3;
constexpr int kEndRounds = 2;

template <typename Condition>
bool all_joints(const Condition& holds) {
  bool all = true;
  for (std::size_t j = 0; j < 6; ++j) all &= holds(j);
  return all;
}

}  // namespace

BranchIntervals::BranchIntervals() {
  intervals_.reserve(kMost);
  divided_.reserve(kMost);
}

void BranchIntervals::begin(SweptBranches& branches) {
  branches_ = &branches;
  intervals_.clear();
  round_ = 0;
  is_overfull_ = false;
  const Places places = branches.places(kPlaces);
  const int last = places.turns ? places.count : places.count - 1;
  for (int branch = 0; branch < SweptBranches::kCount; ++branch) {
    for (int first = 0; first <= last; first += SweptBranches::kCount) {
      branches.solve_one(branch,
                         [&](int lane) { return places.value(std::min(first + lane, last)); });
      for (int lane = 0; lane < SweptBranches::kCount && first + lane <= last; ++lane) {
        nodes_[static_cast<std::size_t>(first + lane)] = branches.node(lane);
      }
    }
    add(branch, last);
  }
}

bool BranchIntervals::divide(FunctionRef<bool(int, int)> take) {
  ++round_;
  std::swap(intervals_, divided_);
  intervals_.clear();
  for (const auto& [branch, lower, upper] : divided_) {
    const double from = lower.value;
    const double step = (upper.value - from) / (SweptBranches::kCount + 1);
    branches_->solve_one(branch, [=](int lane) { return from + step * (lane + 1); });
    nodes_[0] = lower;
    for (int lane = 0; lane < SweptBranches::kCount; ++lane) {
      if (branches_->off(lane) <= 0 && take(lane, branch)) return true;
      nodes_[static_cast<std::size_t>(lane) + 1] = branches_->node(lane);
    }
    nodes_[SweptBranches::kCount + 1] = upper;
    add(branch, SweptBranches::kCount + 1);
  }
  return false;
}

void BranchIntervals::add(int branch, int intervals) {
  const auto count = static_cast<std::size_t>(intervals);
  std::array<BranchWay, kPlaces> ways;
  for (std::size_t i = 0; i < count; ++i) ways[i] = BranchWay(nodes_[i], nodes_[i + 1]);
  for (std::size_t i = 0; i < count; ++i) {
    const BranchWay& before = ways[i == 0 ? 0 : i - 1];
    const BranchWay& behind = ways[std::min(i + 1, count - 1)];
    if (!may_have_answer(nodes_[i], nodes_[i + 1], before, ways[i], behind)) continue;
    if (intervals_.size() == kMost) {
      is_overfull_ = true;
      return;
    }
    intervals_.push_back({branch, nodes_[i], nodes_[i + 1]});
  }
}

bool BranchIntervals::may_have_answer(const BranchNode& lower, const BranchNode& upper,
                                      const BranchWay& before, const BranchWay& here,
                                      const BranchWay& behind) const {
  if (lower.exists() != upper.exists()) {
    // Where the branch ends its joints turn back, as fast as the root of how far it exists.
    if (round_ < kEndRounds) return true;
    const BranchNode& inside = lower.exists() ? lower : upper;
    const BranchWay& beside = lower.exists() ? before : behind;
    return all_joints([&](std::size_t j) {
      const double move = std::max(beside.moves[j], here.moves[j]) + std::sqrt(inside.least);
      return inside.beyond[j] <= kDetour * move;
    });
  }
  double from_closed = 0;
  if (!lower.exists()) {
    // On a closed curve that lies between, it exists by no more than it changes thereabouts.
    const double change = std::max(here.change, std::max(before.change, behind.change));
    if (-lower.least - upper.least > kDetour * change) return false;
    from_closed = std::sqrt(change);
  }
  return all_joints([&](std::size_t j) {
    const double move = std::max(here.moves[j], std::max(before.moves[j], behind.moves[j]));
    return lower.beyond[j] + upper.beyond[j] <= kDetour * (move + from_closed);
  });
}

}  // namespace iksel
