// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/root_finder.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace iksel {
namespace {

constexpr int round_up(int n) { return (n + lanes::kWidth - 1) / lanes::kWidth * lanes::kWidth; }

}  // namespace

RootFinder::RootFinder(double lower, double range, double vague, double precision,
                       const lanes::LaneKernels& kernels)
    : kernels_(kernels),
      turns_(range >= kTwoPi),
      vague_(vague),
      precision_(precision),
      step_(std::min(range, kTwoPi) / kCells),
      angles_(static_cast<std::size_t>(round_up(kBefore + kCells + kAfter))),
      values_(angles_.size()) {
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    angles_[i] = lower + step_ * (static_cast<double>(i) - kBefore);
  }
}

void RootFinder::find(const Residual& residual, double faint) {
  size_ = 0;
  brackets_size_ = 0;
  is_complete_ = true;
  if (turns_) {
    residual(angles_.data() + kBefore, kCells, values_.data() + kBefore);
    std::copy_n(values_.data() + kCells, kBefore, values_.data());
    std::copy_n(values_.data() + kBefore, kAfter, values_.data() + kBefore + kCells);
  } else {
    residual(angles_.data(), static_cast<int>(angles_.size()), values_.data());
  }
  std::array<double, kCells> counts;
  kernels_.count_roots(values_.data() + kBefore, kCells, vague_ / step_, counts.data());
  for (std::size_t i = 0; i < kCells; ++i) {
    if (counts[i] == 0) continue;
    const double left = angles_[kBefore + i];
    if (counts[i] == 1) {
      add_bracket(left, step_, values_.data() + kBefore + i);
    } else {
      const std::size_t before = size_ + brackets_size_;
      const double* ends = values_.data() + kBefore + i;
      look_closer(residual, left, step_, 1);
      // A triple root at an end may by rounding be beyond it as seen from both sides.
      if (size_ + brackets_size_ == before && (ends[0] < 0) != (ends[1] < 0)) {
        add({std::abs(ends[0]) < std::abs(ends[1]) ? left : left + step_, true});
      }
    }
  }
  polish(residual);
  add_faint(faint);
}

void RootFinder::add_faint(double most) {
  // Mostly there are none, which is soon known.
  int faint = 0;
  for (int i = 0; i < kCells; ++i) faint += std::abs(values_[kBefore + i]) <= most ? 1 : 0;
  if (faint == 0) return;
  for (std::size_t i = kBefore; i < kBefore + kCells; ++i) {
    const double here = std::abs(values_[i]);
    if (here > most || here > std::abs(values_[i - 1]) || here > std::abs(values_[i + 1])) continue;
    const bool crosses = values_[i - 1] * values_[i] <= 0 || values_[i] * values_[i + 1] <= 0;
    if (!crosses) add({angles_[i], true, 0, true});
  }
}

double RootFinder::faintest() const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = kBefore; i < kBefore + kCells; ++i) {
    least = std::min(least, std::max(std::abs(values_[i]), std::abs(values_[i + 1])));
  }
  return least;
}

void RootFinder::look_closer(const Residual& residual, double left, double length, int depth) {
  constexpr int kDeepest = 3;
  constexpr int kAngles = kBefore + lanes::kWidth + kAfter + 1;
  static_assert(kAngles % lanes::kWidth == 0);
  const double step = length / lanes::kWidth;
  std::array<double, kAngles> angles;
  std::array<double, kAngles> values;
  for (std::size_t i = 0; i < kAngles; ++i) {
    angles[i] = left + step * (static_cast<double>(i) - kBefore);
  }
  residual(angles.data(), kAngles, values.data());
  std::array<double, lanes::kWidth> counts;
  kernels_.count_roots(values.data() + kBefore, lanes::kWidth, /*apart=*/0, counts.data());
  for (std::size_t i = 0; i < lanes::kWidth; ++i) {
    if (counts[i] == 0) continue;
    const double* at = values.data() + kBefore + i;
    const double here = angles[kBefore + i];
    if (counts[i] == 1) {
      add_bracket(here, step, at);
    } else if (depth < kDeepest) {
      look_closer(residual, here, step, depth + 1);
    } else {
      add({here + step / 2, true});
    }
  }
  // Where it turns above 0 or below: of the parabola through three values, the one in the middle
  // the least.
  for (std::size_t i = kBefore; i <= kBefore + lanes::kWidth; ++i) {
    const double slope = 0.5 * (values[i + 1] - values[i - 1]);
    const double bend = values[i + 1] - 2 * values[i] + values[i - 1];
    if ((bend < 0) == (values[i] < 0) && std::abs(slope) <= 0.5 * std::abs(bend)) {
      const double least = values[i] - 0.5 * slope * slope / bend;
      const double apart = vague_ / step;
      if (std::abs(least) <= 0.5 * std::abs(bend) * apart * apart) {
        const double from_least = step * std::sqrt(2 * std::abs(least / bend));
        add({angles[i] - step * slope / bend, true, from_least});
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

void RootFinder::add(const Root& root) {
  if (size_ == kMost) {
    is_complete_ = false;
    return;
  }
  roots_[size_++] = root;
}

void RootFinder::polish(const Residual& residual) {
  constexpr int kPolishRounds = 40;
  for (std::size_t first = 0; first < brackets_size_; first += lanes::kWidth) {
    const std::size_t n = std::min<std::size_t>(lanes::kWidth, brackets_size_ - first);
    std::array<double, lanes::kWidth> angles{};
    std::array<double, lanes::kWidth> values{};
    bool is_there = false;
    for (int round = 0; round < kPolishRounds && !is_there; ++round) {
      for (std::size_t i = 0; i < n; ++i) angles[i] = brackets_[first + i].next(precision_);
      residual(angles.data(), lanes::kWidth, values.data());
      is_there = true;
      for (std::size_t i = 0; i < n; ++i) {
        brackets_[first + i].narrow(angles[i], values[i]);
        is_there = is_there && brackets_[first + i].is_narrow(precision_);
      }
    }
    for (std::size_t i = 0; i < n; ++i) add({brackets_[first + i].best(), false});
  }
}

double RootFinder::Bracket::next(double precision) const {
  // The share of the way from x1 to x2: by a straight line at first, then by the inverse parabola
  // through three points where that is sure to lie between, else by halves.
  double t = 0.5;
  if (std::isnan(x3)) {
    t = f1 / (f1 - f2);
  } else {
    const double xi = (x1 - x2) / (x3 - x2);
    const double phi = (f1 - f2) / (f3 - f2);
    if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi) {
      t = f1 / (f2 - f1) * (f3 / (f2 - f3)) +
          (x3 - x1) / (x2 - x1) * (f1 / (f3 - f1)) * (f2 / (f3 - f2));
    }
  }
  const double least = std::min(0.5, precision / std::abs(x2 - x1));
  return x1 + std::min(std::max(t, least), 1 - least) * (x2 - x1);
}

void RootFinder::Bracket::narrow(double x, double f) {
  const bool same_side = (f < 0) == (f1 < 0);
  x3 = same_side ? x1 : x2;
  f3 = same_side ? f1 : f2;
  if (!same_side) {
    x2 = x1;
    f2 = f1;
  }
  x1 = x;
  f1 = f;
}

}  // namespace iksel
