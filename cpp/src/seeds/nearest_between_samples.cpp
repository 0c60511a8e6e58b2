// SPDX-License-Identifier: BSD-3-Clause
// What is near may lie between samples: where branches end and the curve turns back, or the wrist
// is all but straight, other joints turn a lot from one sample to the next; and where a joint meets
// a limit, the nearest image is another one from there on.
#include <algorithm>
#include <array>
#include <cstdint>

#include "seeds/least_cost.hpp"
#include "seeds/nearest_on_curve.hpp"

namespace iksel {

void NearestOnCurve::look_between_samples(int branch) {
  const std::uint64_t here = exist_[static_cast<std::size_t>(branch)];
  const std::uint64_t behind = here << 1 | (places_.turns ? here >> (kSamples - 1) : 0);
  for (std::uint64_t both = here & behind; both != 0; both &= both - 1) {
    look_before(__builtin_ctzll(both), branch);
  }
  for (std::uint64_t firsts = here & ~behind; firsts != 0; firsts &= firsts - 1) {
    const int first = __builtin_ctzll(firsts);
    int last = first;
    double least = least_move(places_.value(first));
    while (exists(last + 1, branch)) {
      ++last;
      least = std::min(least, least_move(places_.value(last)));
    }
    if (least - margin_of_step() > best()) continue;
    look_into_span(branch, first, last);
  }
}

void NearestOnCurve::look_before(int place, int branch) {
  // How much more than the swept one other joints turn from one sample to the next.
  constexpr double kSteeper = 4;
  const BranchPoint a = point(sample(place - 1, branch));
  const BranchPoint b = point(sample(place, branch));
  if (!bounds().may_hide_shorter(a, b, bounds().way(a, b), kSteeper * places_.step, best())) {
    return;
  }
  const double value = places_.value(place);
  look_into({branch, value - places_.step, value, false, false}, kDeepest);
}

void NearestOnCurve::look_into_span(int branch, int first, int last) {
  const bool is_short = last - first < kShort;
  BranchSpan span{branch, places_.value(first), places_.value(last), is_none(first - 1, branch),
                  is_none(last + 1, branch)};
  if (!span.folds_below && !span.folds_above) return;
  if (is_short && !short_span_may_be_shorter(branch, first, last)) return;
  const bool below = is_short ? span.folds_below : fold_may_be_shorter(branch, first, -1);
  const bool above = is_short ? span.folds_above : fold_may_be_shorter(branch, last, 1);
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
    look_into(span, kDeepest);
    return;
  }
  if (below) look_into({branch, span.lower, low, true, false}, kDeepest);
  if (above) look_into({branch, high, span.upper, false, true}, kDeepest);
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
    const BranchPoint a = point(sample(place, branch));
    const BranchPoint b = point(sample(place + 1, branch));
    if (std::min(a.loose, b.loose) - bounds().way(a, b).move < best()) return true;
  }
  return fold_may_be_shorter(branch, first, -1) || fold_may_be_shorter(branch, last, 1);
}

bool NearestOnCurve::fold_may_be_shorter(int branch, int end, int side) const {
  if (!is_none(end + side, branch)) return false;
  if (best() == kInfinity) return true;
  const BranchPoint here = point(sample(end, branch));
  // It merges with one that takes the other solution of one of its subproblems, and which ends
  // there too.
  for (const int sign : {1, 2, 4}) {
    const int other = branch ^ sign;
    if (!is_none(end + side, other)) continue;
    if (!exists(end, other)) {
      if (here.loose - kSteep < best()) return true;
    } else if (bounds().may_be_shorter(here, point(sample(end, other)), 2 * places_.step, best())) {
      return true;
    }
  }
  return false;
}

void NearestOnCurve::look_into(const BranchSpan& span, int depth) {
  constexpr double kSpacing = 1.0 / (kCount - 1);
  const auto part = [](std::size_t i) { return kSpacing * static_cast<double>(i); };
  branches_.solve_one(span.branch, [&](int lane) { return span.value(kSpacing * lane); });
  std::array<BranchPoint, kCount> nodes;
  for (int lane = 0; lane < kCount; ++lane) {
    nodes[static_cast<std::size_t>(lane)] = branches_.point(lane);
  }
  // From each node to the next.
  std::array<MoveBounds::Way, kCount - 1> ways;
  for (std::size_t i = 0; i < ways.size(); ++i) ways[i] = bounds().way(nodes[i], nodes[i + 1]);

  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i > 0 && cost(nodes[i]) > cost(nodes[i - 1])) continue;
    if (i < ways.size() && cost(nodes[i]) > cost(nodes[i + 1])) continue;
    const MoveBounds::Way& before = ways[i > 0 ? i - 1 : 0];
    const MoveBounds::Way& behind = ways[std::min(i, ways.size() - 1)];
    const MoveBounds::Way widest{std::max(before.move, behind.move),
                                 std::max(before.largest, behind.largest)};
    if (may_lead_to_shorter(cost(nodes[i]), widest)) follow(span, part(i), kSpacing, widest);
  }
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (!bounds().may_hide_shorter(nodes[i], nodes[i + 1], ways[i], 0, best())) continue;
    if (depth == 0) {
      add_swing(nodes[i], nodes[i + 1]);
      continue;
    }
    if (spans_left_ == 0) return;
    --spans_left_;
    look_into({span.branch, span.value(part(i)), span.value(part(i + 1)), false, false}, depth - 1);
  }
}

bool NearestOnCurve::may_lead_to_shorter(double cost, const MoveBounds::Way& way) const {
  // Nothing is begun for less; but what is the best so far is followed to its end [rad].
  constexpr double kGain = 1e-3;
  if (cost >= kRefused) return cost - kRefused < way.largest;
  return cost < best() || cost - way.move < best() - kGain;
}

void NearestOnCurve::add_swing(const BranchPoint& a, const BranchPoint& b) {
  const BranchPoint nearest = bounds().nearest_between(a, b);
  if (!(nearest.inside < best())) return;
  SweptJoints found{nearest.inside, {}};
  branches_.copy_joints(nearest, found.q.data());
  found_.add(found);
}

void NearestOnCurve::follow(const BranchSpan& span, double part, double width,
                            const MoveBounds::Way& way) {
  SweptJoints best{kInfinity, {}};
  const auto value = [&](double p) { return span.value(std::min(std::max(p, 0.0), 1.0)); };
  const auto take = [&](int lane, double) { branches_.copy_joints(lane, best.q.data()); };
  const Bracket bracket{span.branch, part, width, kNarrowings, kFinest * width, !takes_largest_};
  best.value = minimize(
      branches_, bracket, value, [&](int lane) { return cost(lane); }, kRefused, take,
      [&](double so_far, int round) {
        // Each round looks at less than a quarter of the way.
        const double part_of_way = 1.0 / (1 << 2 * round);
        return round > 0 &&
               !may_lead_to_shorter(so_far, {part_of_way * way.move, part_of_way * way.largest});
      });
  if (best.value < kRefused) found_.add(best);
}

}  // namespace iksel
