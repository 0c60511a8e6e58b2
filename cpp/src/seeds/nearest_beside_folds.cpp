// SPDX-License-Identifier: BSD-3-Clause
// Where branches end, and the curve turns back: from one sample to the next the other joints turn a
// lot there, and what is near lies between samples.
#include <algorithm>
#include <array>
#include <cstdint>

#include "seeds/least_cost.hpp"
#include "seeds/nearest_on_curve.hpp"

namespace iksel {

void NearestOnCurve::look_beside_folds(int branch) {
  const std::uint64_t here = exist_[static_cast<std::size_t>(branch)];
  const std::uint64_t behind = here << 1 | (places_.turns ? here >> (kSamples - 1) : 0);
  for (std::uint64_t firsts = here & ~behind; firsts != 0; firsts &= firsts - 1) {
    const int first = __builtin_ctzll(firsts);
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
  SweptBranches::Fold fold_below = fold_beside(branch, first, -1);
  SweptBranches::Fold fold_above = fold_beside(branch, last, 1);
  const auto narrow = [&] {
    if (below) branches_.narrow(branch, 1, fold_below);
    if (below) span.lower = fold_below.end();
    if (above) branches_.narrow(branch, 1, fold_above);
    if (above) span.upper = fold_above.end();
  };
  narrow();
  if (is_short && span.upper - span.lower < places_.step) narrow();
  if (is_short && (below || above)) {
    look_into(span, 2);
    return;
  }
  if (below) look_into({branch, span.lower, low, true, false}, 1);
  if (above) look_into({branch, high, span.upper, false, true}, 1);
}

SweptBranches::Fold NearestOnCurve::fold_beside(int branch, int end, int side) const {
  if (!is_none(end + side, branch)) return {};
  SweptBranches::Fold fold{places_.value(end), places_.value(end) + side * places_.step,
                           least(end, branch), least(end + side, branch)};
  if (exists(end - side, branch)) {
    fold.before = places_.value(end - side);
    fold.least_before = least(end - side, branch);
  }
  return fold;
}

bool NearestOnCurve::short_span_may_be_shorter(int branch, int first, int last) const {
  // With one sample, nothing tells how steep it is.
  if (best() == kInfinity || first == last) return true;
  for (int place = first; place < last; ++place) {
    const double loose = std::min(sample(place, branch).loose(), sample(place + 1, branch).loose());
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
    if (sample(end, other).loose() - steep - kSteep < best()) return true;
  }
  return false;
}

bool NearestOnCurve::jumps(int place, int branch) const {
  if (!may_lead_to_shorter(place, place - 1, branch)) return false;
  const Sample a = sample(place - 1, branch);
  const Sample b = sample(place, branch);
  return branches_.jumps(a.row, a.lane, b.row, b.lane);
}

bool NearestOnCurve::may_lead_to_shorter(int place, int beside, int branch) const {
  const double loose = std::min(sample(place, branch).loose(), sample(beside, branch).loose());
  return best() == kInfinity || loose - kSteep < best();
}

void NearestOnCurve::solve_nodes(const BranchSpan& span, double from, double spacing, Node* nodes) {
  const auto part = [&](int lane) { return from + spacing * (lane + 0.5); };
  branches_.solve_one(span.branch, [&](int lane) { return span.value(part(lane)); });
  const lanes::MovePack& moves = branches_.moves();
  for (int lane = 0; lane < kCount; ++lane) {
    Node& node = nodes[lane];
    node.part = part(lane);
    node.cost = cost(lane);
    node.loose = moves.loose[lane];
    node.off = moves.off[lane];
    branches_.copy_joints(lane, node.q.data());
  }
}

bool NearestOnCurve::may_be_shorter(const Node& a, const Node& b, const Way& way) const {
  // The curve between two nodes is longer than a straight line by no more than so much.
  constexpr double kCurved = 1.5;
  return a.loose + b.loose - kCurved * way.move <= 2 * best() &&
         a.off + b.off - kCurved * way.largest <= 0;
}

bool NearestOnCurve::narrow_to_shorter(const BranchSpan& span, double& from, double& to) {
  std::array<Node, kCount> nodes;
  const double spacing = (to - from) / kCount;
  solve_nodes(span, from, spacing, nodes.data());
  int first = kCount;
  int last = -1;
  const auto take = [&](int low, int high) {
    first = std::min(first, low);
    last = std::max(last, high);
  };
  for (int i = 0; i + 1 < kCount; ++i) {
    const Node& a = nodes[static_cast<std::size_t>(i)];
    const Node& b = nodes[static_cast<std::size_t>(i + 1)];
    const Way way = way_between(a.q, b.q);
    if (may_be_shorter(a, b, way)) take(i, i + 1);
    // Before the first and behind the last it goes on as beside them.
    if (i == 0 && may_be_shorter(a, a, way)) take(i, i);
    if (i + 2 == kCount && may_be_shorter(b, b, way)) take(i + 1, i + 1);
  }
  if (last < 0) return false;
  to = std::min(from + spacing * (last + 1.5), to);
  from = std::max(from + spacing * (first - 0.5), from);
  return true;
}

void NearestOnCurve::look_into(const BranchSpan& span, int packs) {
  constexpr std::size_t kMostNodes = 16;
  std::array<Node, kMostNodes> nodes;
  const auto count = static_cast<std::size_t>(packs * kCount);
  double from = 0;
  double to = 1;
  if (packs > 1 && !narrow_to_shorter(span, from, to)) return;
  const double spacing = (to - from) / static_cast<double>(count);
  for (int pack = 0; pack < packs; ++pack) {
    solve_nodes(span, from + spacing * pack * kCount, spacing,
                &nodes[static_cast<std::size_t>(pack * kCount)]);
  }
  for (std::size_t i = 0; i < count; ++i) {
    bool is_least = true;
    bool is_worth_it = false;
    for (const std::size_t beside : {i - 1, i + 1}) {
      if (beside >= count) continue;
      is_least = is_least && nodes[i].cost <= nodes[beside].cost;
      is_worth_it =
          is_worth_it || (is_least && may_be_shorter(nodes[i], nodes[beside],
                                                     way_between(nodes[i].q, nodes[beside].q)));
    }
    if (is_least && is_worth_it) follow(span, nodes[i].part, spacing);
  }
}

void NearestOnCurve::follow(const BranchSpan& span, double part, double width) {
  SweptJoints best{kInfinity, {}};
  const auto value = [&](double p) { return span.value(std::min(std::max(p, 0.0), 1.0)); };
  const auto take = [&](int lane, double) { branches_.copy_joints(lane, best.q.data()); };
  const Bracket bracket{span.branch, part, width, kNarrowings, kFinest * width, !takes_largest_};
  best.value = minimize(
      branches_, bracket, value, [&](int lane) { return cost(lane); }, kRefused, take,
      [&](double so_far, int round) { return is_hopeless(so_far, round); });
  if (best.value < kRefused) found_.add(best);
}

}  // namespace iksel
