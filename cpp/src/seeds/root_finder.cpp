// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/root_finder.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace iksel {
namespace {

constexpr int kBlock = lanes::kWidth;
constexpr int round_up(int n) { return (n + kBlock - 1) / kBlock * kBlock; }

}  // namespace

RootFinder::RootFinder(double lower, double range, double vague, const lanes::LaneKernels& kernels)
    : kernels_(kernels),
      turns_(range >= kTwoPi),
      vague_(vague),
      step_(std::min(range, kTwoPi) / kCells),
      angles_(static_cast<std::size_t>(round_up(kBefore + kCells + kAfter))),
      values_(angles_.size()) {
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    angles_[i] = lower + step_ * (static_cast<double>(i) - kBefore);
  }
}

void RootFinder::find(const lanes::ResidualForm& form) {
  size_ = 0;
  brackets_size_ = 0;
  is_complete_ = true;
  if (turns_) {
    kernels_.find_residuals(form, angles_.data() + kBefore, kCells, values_.data() + kBefore);
    std::copy_n(values_.data() + kCells, kBefore, values_.data());
    std::copy_n(values_.data() + kBefore, kAfter, values_.data() + kBefore + kCells);
  } else {
    kernels_.find_residuals(form, angles_.data(), static_cast<int>(angles_.size()), values_.data());
  }
  std::array<double, kCells> counts;
  kernels_.count_roots(values_.data() + kBefore, kCells, counts.data());
  for (std::size_t i = 0; i < kCells; ++i) {
    if (counts[i] == 0) continue;
    const double left = angles_[kBefore + i];
    if (counts[i] == 1) {
      add_bracket(left, step_, values_.data() + kBefore + i);
    } else {
      look_closer(form, left, step_, 1);
    }
  }
  polish(form);
}

void RootFinder::look_closer(const lanes::ResidualForm& form, double left, double length,
                             int depth) {
  constexpr int kDeepest = 3;
  constexpr int kInside = kBlock;
  constexpr int kAngles = kBefore + kInside + kAfter + 1;
  static_assert(kAngles % kBlock == 0);
  const double step = length / kInside;
  std::array<double, kAngles> angles;
  std::array<double, kAngles> values;
  for (std::size_t i = 0; i < kAngles; ++i) {
    angles[i] = left + step * (static_cast<double>(i) - kBefore);
  }
  kernels_.find_residuals(form, angles.data(), kAngles, values.data());
  std::array<double, kInside> counts;
  kernels_.count_roots(values.data() + kBefore, kInside, counts.data());
  for (std::size_t i = 0; i < kInside; ++i) {
    if (counts[i] == 0) continue;
    const double* at = values.data() + kBefore + i;
    const double here = angles[kBefore + i];
    if (counts[i] == 1) {
      add_bracket(here, step, at);
    } else if (depth < kDeepest) {
      look_closer(form, here, step, depth + 1);
    } else {
      add(here + step / 2, true);
    }
  }
  // Where it turns above 0 or below: of the parabola through three values, the one in the middle
  // the least.
  for (std::size_t i = kBefore; i <= kBefore + kInside; ++i) {
    const double slope = 0.5 * (values[i + 1] - values[i - 1]);
    const double bend = values[i + 1] - 2 * values[i] + values[i - 1];
    if ((bend < 0) == (values[i] < 0) && std::abs(slope) <= 0.5 * std::abs(bend)) {
      const double least = values[i] - 0.5 * slope * slope / bend;
      const double apart = vague_ / step;
      if (std::abs(least) <= 0.5 * std::abs(bend) * apart * apart) {
        add(angles[i] - step * slope / bend, true);
      }
    }
  }
}

void RootFinder::add_bracket(double left, double length, const double* value) {
  if (brackets_size_ == kMost) {
    is_complete_ = false;
    return;
  }
  brackets_[brackets_size_++] = {left, left + length, value[0], value[1]};
}

void RootFinder::add(double angle, bool is_vague) {
  if (size_ == kMost) {
    is_complete_ = false;
    return;
  }
  roots_[size_++] = {angle, is_vague};
}

void RootFinder::polish(const lanes::ResidualForm& form) {
  // By regula falsi as Anderson and Bjorck have it, 1973.
  constexpr int kRounds = 15;
  constexpr double kThere = 1e-9;
  for (std::size_t first = 0; first < brackets_size_; first += kBlock) {
    const std::size_t n = std::min<std::size_t>(kBlock, brackets_size_ - first);
    std::array<double, kBlock> angles{};
    std::array<double, kBlock> values{};
    double moved = step_;
    for (int round = 0; round < kRounds && moved > kThere; ++round) {
      moved = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const Bracket& b = brackets_[first + i];
        angles[i] = b.left + (b.right - b.left) * b.at_left / (b.at_left - b.at_right);
      }
      kernels_.find_residuals(form, angles.data(), kBlock, values.data());
      for (std::size_t i = 0; i < n; ++i) {
        Bracket& b = brackets_[first + i];
        moved = std::max(moved, std::abs(angles[i] - b.right));
        // `right` is the newer end, whichever side it is on.
        if ((values[i] < 0) != (b.at_right < 0)) {
          b.left = b.right;
          b.at_left = b.at_right;
        } else {
          const double kept = 1 - values[i] / b.at_right;
          b.at_left *= kept > 0 ? kept : 0.5;
        }
        b.right = angles[i];
        b.at_right = values[i];
      }
    }
    for (std::size_t i = 0; i < n; ++i) add(brackets_[first + i].right, false);
  }
}

}  // namespace iksel
