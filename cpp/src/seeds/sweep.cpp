// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "seeds/least_cost.hpp"

namespace iksel {

Sweep::Sweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
             double tolerance, const lanes::LaneKernels& kernels)
    : joints_(model.joints),
      branches_(model, chain, kernels),
      places_(branches_.places(kSamples)),
      miss_(is_nominal, tolerance),
      rows_(kSamples) {}

bool Sweep::find_at_samples(const Pose& Y) {
  set_target(Y);
  for (int pack = 0; pack < kPacks; ++pack) {
    // Far from each other first, so that an answer is soon found.
    constexpr int kStride = 5;
    static_assert(std::gcd(kStride, kPacks) == 1, "each pack once");
    const int first = pack * kStride % kPacks * SweptBranches::kCount;
    SweptBranches::Row* rows = &rows_[static_cast<std::size_t>(first)];
    branches_.rate([&](int i) { return places_.value(first + i); }, kNear, rows);
    for (int i = 0; i < SweptBranches::kCount; ++i) {
      if (take_answer(first + i)) return true;
    }
  }
  return false;
}

bool Sweep::find_between() {
  nearest_.find(places_, rows_, kNear);
  least_ = kInfinity;
  close_.clear();
  for (const LeastPlace& near : nearest_) {
    least_ = std::min(least_, near.value);
    if (is_left_to_another(near)) continue;
    if (follow(near)) return true;
  }
  return find_in_intervals();
}

void Sweep::visit_nearest(std::size_t most, FunctionRef<void(const JointVector&)> visit) {
  JointVector q(kCurveJoints);
  for (const LeastPlace& near : nearest_) {
    if (most-- == 0) return;
    branches_.solve_all(places_.value(near.place));
    branches_.copy_joints(near.branch, q.data());
    visit(q);
  }
}

bool Sweep::take_answer(int place) {
  const SweptBranches::Row& off = rows_[static_cast<std::size_t>(place)];
  if (least_of(off) > 0) return false;
  branches_.solve_all(places_.value(place));
  for (int branch = 0; branch < SweptBranches::kCount; ++branch) {
    if (off[static_cast<std::size_t>(branch)] <= 0 && take(branch, branch)) return true;
  }
  return false;
}

bool Sweep::take(int lane, int branch) {
  // What is rated as an answer is one but for rounding; or it is outside of limits where any angle
  // would do.
  constexpr double kRounding = 1e-9;
  if (branches_.off(lane) > kRounding) return false;
  branches_.copy_inside(lane, q_.data());
  branch_ = branch;
  return true;
}

void Sweep::add_samples(const Pose& Y, int first, int stride, std::vector<double>& q) {
  std::vector<Sample> samples;
  set_target(Y);
  add_samples(first, stride, q, samples);
}

void Sweep::add_samples(int first, int stride, std::vector<double>& q,
                        std::vector<Sample>& samples) {
  // Eight places are rated in the time in which two or three are solved.
  const int count = (kSamples - first + stride - 1) / stride;
  SweptBranches::Row rows[SweptBranches::kCount];
  for (int i = 0; i < count; ++i) {
    const int lane_of_row = i % SweptBranches::kCount;
    const auto place_of = [&](int k) { return first + stride * std::min(k, count - 1); };
    if (lane_of_row == 0) {
      branches_.rate([&](int k) { return places_.value(place_of(i + k)); }, kNear, rows);
    }
    const SweptBranches::Row& off = rows[lane_of_row];
    const int place = place_of(i);
    rows_[static_cast<std::size_t>(place)] = off;
    if (least_of(off) > 0) continue;
    branches_.solve_all(places_.value(place));
    for (int lane = 0; lane < SweptBranches::kCount; ++lane) {
      if (branches_.off(lane) > 0) continue;
      branches_.copy_joints(lane, q_.data());
      q.insert(q.end(), q_.begin(), q_.end());
      samples.push_back({place, lane});
    }
  }
}

void Sweep::add_end(const Sample& inside, bool up, std::vector<double>& q) {
  constexpr int kRounds = 4;
  double from = places_.value(inside.place);
  double to = from + (up ? places_.step : -places_.step);
  for (int round = 0; round < kRounds; ++round) {
    const double step = (to - from) / (SweptBranches::kCount + 1);
    const auto value = [&](int lane) { return branches_.clamp(from + step * (lane + 1)); };
    branches_.solve_one(inside.branch, value);
    int count = 0;
    while (count < SweptBranches::kCount && branches_.off(count) <= 0) ++count;
    if (count > 0) {
      branches_.copy_joints(count - 1, q_.data());
      q.insert(q.end(), q_.begin(), q_.end());
    }
    from += step * count;
    to = from + step;
  }
}

void Sweep::visit_between(FunctionRef<void(const double* q, int branch)> visit) {
  nearest_.find(places_, rows_, kNear, 0);
  least_ = kInfinity;
  close_.clear();
  for (const LeastPlace& near : nearest_) {
    if (follow(near)) visit(q_.data(), branch_);
  }
}

void Sweep::add_beside(const double* from, int branch, double part, std::vector<double>& q) {
  // Without the middle and the ends, which are samples.
  constexpr double kHalf = (SweptBranches::kCount + 2) / 2.0;
  const double middle = from[branches_.joint()];
  const double spacing = part * kSpacingBeside * places_.step;
  branches_.solve_one(branch, [&](int lane) {
    const int place = lane < SweptBranches::kCount / 2 ? lane + 1 : lane + 2;
    return branches_.clamp(middle + spacing * (place - kHalf));
  });
  for (int lane = 0; lane < SweptBranches::kCount; ++lane) {
    if (branches_.off(lane) > 0) continue;
    branches_.copy_joints(lane, q_.data());
    q.insert(q.end(), q_.begin(), q_.end());
  }
}

namespace {

/// Branches of which all that is asked is how far they are from being an answer.
struct RatedBranches {
  SweptBranches& branches;
  double bound;  ///< what is more is not known
  double off[SweptBranches::kCount];

  template <typename Value>
  void solve_one(int branch, const Value& value) {
    branches.rate_one(branch, value, bound, off);
  }
};

/// Whether of two branches that merge, and differ by one of three signs, it is the second.
bool is_second_of_merged(int branch) {
  return __builtin_parity(static_cast<unsigned>(branch)) != 0;
}

/// From the middle of a small closed curve, where Newton's steps lead nowhere: the arm is singular
/// there. In a direction that is none of the arm's.
void step_aside(std::array<double, kCurveJoints>& q) {
  constexpr double kAside = 3e-3;  // [rad or m]; of loops from 1e-3 on
  for (std::size_t j = 0; j < q.size(); ++j) q[j] += kAside * std::cos(static_cast<double>(j));
}

}  // namespace

bool Sweep::find_in_intervals() {
  // Measured by what measures BranchIntervals' own.
  constexpr int kRounds = 4;
  intervals_.begin(branches_);
  for (int round = 0; round < kRounds && !intervals_.is_empty(); ++round) {
    if (intervals_.divide([&](int lane, int branch) { return take(lane, branch); })) return true;
  }
  intervals_.visit([&](int branch, double value) {
    branches_.solve_one(branch, [&](int /*lane*/) { return value; });
    least_ = std::min(least_, branches_.off(0));
    keep_if_close(branches_.off(0), branches_.least(0) < 0 && is_second_of_merged(branch));
  });
  if (intervals_.is_overfull()) least_ = 0;
  return false;
}

void Sweep::keep_if_close(double off, bool is_aside) {
  if (!miss_.is_close(off)) return;
  SweptJoints close{off, {}};
  branches_.copy_joints(0, close.q.data());
  if (is_aside) step_aside(close.q);
  close_.add(close);
}

bool Sweep::is_left_to_another(const LeastPlace& near) const {
  if (!is_second_of_merged(near.branch)) return false;
  return std::any_of(nearest_.begin(), nearest_.end(), [&](const LeastPlace& other) {
    return other.place == near.place && other.value == near.value &&
           !is_second_of_merged(other.branch);
  });
}

bool Sweep::follow(const LeastPlace& near) {
  constexpr int kRounds = 8;
  // Of 4,491 answers found so, of five arms, none was farther off after one round, two and three
  // than 0.09, 0.03 and 0.015.
  constexpr std::array<double, 3> kHopeless{0.2, 0.1, 0.05};
  const auto value = [&](double place) { return branches_.clamp(place); };
  RatedBranches rated{branches_, kHopeless.front(), {}};
  const auto off = [&](int lane) { return rated.off[lane]; };
  double best_at = places_.value(near.place);
  const auto go_there = [&](int /*lane*/, double place) { best_at = place; };
  const auto is_enough = [&](double least, int round) {
    if (least <= 0) return true;
    const std::size_t looked = std::min(static_cast<std::size_t>(round), kHopeless.size());
    return looked > 0 && least > kHopeless[looked - 1];
  };
  const Bracket bracket{near.branch, places_.value(near.place), places_.step, kRounds, 0, false,
                        near.value};
  const double least = minimize(rated, bracket, value, off, kInfinity, go_there, is_enough);
  least_ = std::min(least_, least);
  if (!miss_.is_close(least)) return false;
  branches_.solve_one(near.branch, [&](int /*lane*/) { return value(best_at); });
  if (least <= 0 && take(0, near.branch)) return true;
  keep_if_close(least, /*is_aside=*/false);
  if (branches_.least(0) < 0) keep_if_close(least, /*is_aside=*/true);
  return false;
}

}  // namespace iksel
