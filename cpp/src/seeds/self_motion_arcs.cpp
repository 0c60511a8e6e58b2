// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/self_motion_arcs.hpp"

#include <algorithm>
#include <cmath>

#include "seeds/least_cost.hpp"

namespace iksel {

SelfMotionArcs::SelfMotionArcs(const ChainModel& model, const ClosedFormChain& chain,
                               const lanes::LaneKernels& kernels)
    : branches_(model, chain, kernels),
      places_(branches_.places(kSamples)),
      joints_(model.joints),
      least_(kSamples) {}

void SelfMotionArcs::find(const Pose& Y, double spacing) {
  pieces_.clear();
  spans_.clear();
  arcs_.clear();
  branches_.set_target(Y);
  places_ = branches_.places(kSamples);
  sweep();
  for (int branch = 0; branch < kLanes; ++branch) {
    mark(branch);
    find_spans(branch);
  }
  join();
  find_partners();
  join();
  chain(spacing);
}

void SelfMotionArcs::sweep() {
  for (int place = 0; place < places_.count; ++place) {
    branches_.solve_all(places_.value(place));
    for (int lane = 0; lane < kLanes; ++lane) {
      least_[static_cast<std::size_t>(place)][static_cast<std::size_t>(lane)] =
          branches_.least(lane);
    }
  }
}

void SelfMotionArcs::mark(int branch) {
  const auto i = static_cast<std::size_t>(branch);
  marks_.clear();
  for (int place = 0; place < places_.count; ++place) {
    marks_.push_back({places_.value(place), least_[static_cast<std::size_t>(place)][i] >= 0});
  }
  for (int place = 0; place < places_.count; ++place) mark_between(branch, place);
  std::sort(marks_.begin(), marks_.end(),
            [](const Mark& a, const Mark& b) { return a.value < b.value; });
}

void SelfMotionArcs::mark_between(int branch, int place) {
  const auto least = [&](int at) {
    const int found = places_.find(at);
    const auto i = static_cast<std::size_t>(branch);
    return least_[static_cast<std::size_t>(found < 0 ? place : found)][i];
  };
  const bool exists = least(place) >= 0;
  // Looked at so that it is a least of what is above 0.
  const double sign = exists ? 1 : -1;
  const double here = sign * least(place);
  const double left = sign * least(place - 1);
  const double right = sign * least(place + 1);
  if (left < 0 || right < 0 || here > left || here > right) return;
  if (lowest_between(left, here, right) > 0) return;
  constexpr int kRounds = 6;
  double found_at = 0;
  const auto value = [&](double at) { return branches_.clamp(at); };
  const auto cost = [&](int lane) { return sign * branches_.least(lane); };
  const auto take = [&](int /*lane*/, double at) { found_at = value(at); };
  const auto is_enough = [&](double so_far, int) { return exists ? so_far < 0 : so_far <= 0; };
  const Bracket bracket{branch, places_.value(place), places_.step, kRounds, 0, true};
  const double found = minimize(branches_, bracket, value, cost, kInfinity, take, is_enough);
  if (is_enough(found, kRounds)) marks_.push_back({found_at, !exists});
}

void SelfMotionArcs::find_spans(int branch) {
  const auto count = static_cast<int>(marks_.size());
  const auto exists = [&](int i) { return marks_[static_cast<std::size_t>(i % count)].exists; };
  const auto value = [&](int i) {
    return marks_[static_cast<std::size_t>(i % count)].value + (i >= count ? kTwoPi : 0.0);
  };
  // Of a whole turn, from a place on where the branch does not exist.
  int begin = 0;
  while (places_.turns && begin < count && exists(begin)) ++begin;
  if (places_.turns && begin == count) {
    add_span({branch, value(0), value(0) + kTwoPi, false, false});
    return;
  }
  const int end = begin + count;
  for (int i = begin; i < end; ++i) {
    if (!exists(i)) continue;
    int last = i;
    while (last + 1 < end && exists(last + 1)) ++last;
    BranchSpan span{branch, value(i), value(last), places_.turns || i > 0,
                    places_.turns || last + 1 < end};
    if (span.folds_below) {
      const double outside = value(i > 0 ? i - 1 : i - 1 + count) - (i > 0 ? 0.0 : kTwoPi);
      span.lower = branches_.last_existing(branch, span.lower, outside, kEndRounds);
    }
    if (span.folds_above) {
      span.upper = branches_.last_existing(branch, span.upper, value(last + 1), kEndRounds);
    }
    add_span(span);
    i = last;
  }
}

void SelfMotionArcs::add_span(const BranchSpan& span) {
  spans_.push_back(span);
  // As near to each other as samples, and so many at least: the other joints turn as far in a short
  // span as in a long one.
  constexpr int kLeast = 3;
  const auto packs =
      static_cast<int>(std::ceil(1.5 * (span.upper - span.lower) / (places_.step * kLanes)));
  sample(span, kLanes * std::max(packs, kLeast));
  sample_densely(span);
  sample_between(span);
  cut(span);
}

}  // namespace iksel
