// SPDX-License-Identifier: BSD-3-Clause
// Where branches end, and the curve turns back: from one sample to the next the other joints turn a
// lot there, and what is near lies between samples.
#include <algorithm>
#include <array>

#include "seeds/least_cost.hpp"
#include "seeds/nearest_on_curve.hpp"

namespace iksel {

void NearestOnCurve::look_beside_folds(int branch) {
  for (int first = below_ + 1; first < above_; ++first) {
    if (!exists(first, branch) || exists(first - 1, branch)) continue;
    int last = first;
    double least = least_move(places_.value(first));
    while (exists(last + 1, branch)) {
      ++last;
      least = std::min(least, least_move(places_.value(last)));
      if (jumps(last, branch)) {
        look_into({branch, places_.value(last - 1), places_.value(last), false, false}, 1);
      }
    }
    if (least - margin_of_step() > best()) continue;
    look_into_span(branch, first, last);
  }
}

void NearestOnCurve::look_into_span(int branch, int first, int last) {
  const bool is_short = last - first < kShort;
  BranchSpan span{branch, places_.value(first), places_.value(last), is_none(first - 1, branch),
                  is_none(last + 1, branch)};
  if (!span.folds_below && !span.folds_above) return;
  if (is_short && !short_span_may_be_shorter(branch, first, last)) return;
  const bool below =
      span.folds_below && (is_short || may_lead_to_shorter(first, first - 1, branch));
  const bool above = span.folds_above && (is_short || may_lead_to_shorter(last, last + 1, branch));
  const double low = span.lower;
  const double high = span.upper;
  const int rounds = is_short ? 2 : 1;
  if (below) span.lower = branches_.find_fold(branch, low, low - places_.step, rounds);
  if (above) span.upper = branches_.find_fold(branch, high, high + places_.step, rounds);
  if (is_short && (below || above)) {
    look_into(span, 3);
    return;
  }
  if (below) look_into({branch, span.lower, low, true, false}, 1);
  if (above) look_into({branch, high, span.upper, false, true}, 1);
}

bool NearestOnCurve::short_span_may_be_shorter(int branch, int first, int last) const {
  // With one sample, nothing tells how steep it is.
  if (best() == kInfinity || first == last) return true;
  for (int place = first; place < last; ++place) {
    const double loose = std::min(sample(place, branch).loose, sample(place + 1, branch).loose);
    if (loose - distance(place, place + 1, branch) < best()) return true;
  }
  return fold_may_be_shorter(branch, first, -1) || fold_may_be_shorter(branch, last, 1);
}

bool NearestOnCurve::fold_may_be_shorter(int branch, int end, int side) const {
  if (!is_none(end + side, branch)) return false;
  // Joints that change as the root of the swept one's distance from the fold change from the last
  // sample to the fold at most 1 / (sqrt(2) - 1) = 2.4 times as much as from the one before it.
  // With that alone, 3 of 10,000 answers of panda were lost, with this none.
  constexpr double kSteepest = 4;
  for (int other = 0; other < SweptBranches::kCount; ++other) {
    // That branch merges with one of those that end there too.
    if (!exists(end, other) || !is_none(end + side, other)) continue;
    const double steep =
        exists(end - side, other) ? kSteepest * distance(end, end - side, other) : kInfinity;
    if (sample(end, other).loose - steep - kSteep < best()) return true;
  }
  return false;
}

bool NearestOnCurve::jumps(int place, int branch) const {
  return may_lead_to_shorter(place, place - 1, branch) &&
         branches_.jumps(sample(place - 1, branch).q.data(), sample(place, branch).q.data());
}

bool NearestOnCurve::may_lead_to_shorter(int place, int beside, int branch) const {
  const double loose = std::min(sample(place, branch).loose, sample(beside, branch).loose);
  return best() == kInfinity || loose - kSteep < best();
}

void NearestOnCurve::look_into(const BranchSpan& span, int packs) {
  constexpr int kMostPacks = 3;
  const int nodes = packs * SweptBranches::kCount;
  std::array<double, kMostPacks * SweptBranches::kCount> costs, loose;
  const auto part = [&](int node) { return (node + 0.5) / nodes; };
  const auto value = [&](double p) { return span.value(std::min(std::max(p, 0.0), 1.0)); };
  for (int first = 0; first < nodes; first += SweptBranches::kCount) {
    branches_.solve_one(span.branch, [&](int lane) { return value(part(first + lane)); });
    for (int lane = 0; lane < SweptBranches::kCount; ++lane) {
      costs[static_cast<std::size_t>(first + lane)] = cost(lane);
      loose[static_cast<std::size_t>(first + lane)] = branches_.moves().loose[lane];
    }
  }
  const auto at = [&](int node) {
    return node < 0 || node >= nodes ? kInfinity : costs[static_cast<std::size_t>(node)];
  };
  for (int node = 0; node < nodes; ++node) {
    if (at(node) > at(node - 1) || at(node) > at(node + 1)) continue;
    const double move = loose[static_cast<std::size_t>(node)];
    if (std::min(at(node), move) - kSteep > best()) continue;
    if (at(node) > kRefused + kNear) continue;
    SweptJoints best{kInfinity, {}};
    const auto take = [&](int lane, double) { branches_.copy_joints(lane, best.q.data()); };
    const Bracket bracket{span.branch, part(node),      1.0 / nodes,
                          kNarrowings, kFinest / nodes, !takes_largest_};
    best.value = minimize(
        branches_, bracket, value, [&](int lane) { return cost(lane); }, kRefused, take,
        [&](double so_far, int round) { return is_hopeless(so_far, round); });
    if (best.value < kRefused) found_.add(best);
  }
}

}  // namespace iksel
