// SPDX-License-Identifier: BSD-3-Clause
// What is near may lie beside folds, where two branches of a swept joint merge and the curve turns
// back: there the other joints change as the root of the swept one, and from far beyond limits to
// inside from one sample to the next. A loop has folds at both ends, all of it between samples.
#include <algorithm>
#include <array>
#include <cstdint>

#include "seeds/nearest_on_curve.hpp"

namespace iksel {

void NearestOnCurve::look_into_span(int branch, int first, int last) {
  if (last - first < kShort) {
    look_into_short_span(branch, first, last);
    return;
  }
  const bool below = fold_may_be_shorter(branch, first, -1);
  const bool above = fold_may_be_shorter(branch, last, 1);
  const auto look_at_end = [&](int end, int side) {
    SweptBranches::Fold fold = fold_beside(branch, end, side);
    if (!narrow_where_shorter(branch, point(sample(end, branch)), fold)) return;
    look_into_fold(branch, places_.value(end), fold);
  };
  if (below) look_at_end(first, -1);
  if (above) look_at_end(last, 1);
}

void NearestOnCurve::look_into_short_span(int branch, int first, int last) {
  BranchSpan span{branch, places_.value(first), places_.value(last), is_none(first - 1, branch),
                  is_none(last + 1, branch)};
  if (!span.folds_below && !span.folds_above) return;
  if (!short_span_may_be_shorter(branch, first, last)) return;
  SweptBranches::Fold below = fold_beside(branch, first, -1);
  SweptBranches::Fold above = fold_beside(branch, last, 1);
  const auto narrow = [&] {
    if (span.folds_below) branches_.narrow(branch, 1, below);
    if (span.folds_below) span.lower = below.end();
    if (span.folds_above) branches_.narrow(branch, 1, above);
    if (span.folds_above) span.upper = above.end();
  };
  narrow();
  if (span.upper - span.lower < places_.step) narrow();
  const Ends ends = look_into(span, kDeepest);
  const auto look_at_end = [&](SweptBranches::Fold& fold) {
    const double inside = fold.inside;
    branches_.narrow(branch, 1, fold);
    look_into_fold(branch, inside, fold);
  };
  if (span.folds_below && ends.below) look_at_end(below);
  if (span.folds_above && ends.above) look_at_end(above);
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
    if (!is_none(end + side, other) || are_beyond(end, branch, other)) continue;
    if (is_none(end, other)) {
      if (exists(end, branch) && here.loose - kSteep < best()) return true;
    } else if (bounds().may_be_shorter(here, point(sample(end, other)), places_.step, best())) {
      return true;
    }
  }
  return false;
}

bool NearestOnCurve::are_beyond(int place, int branch, int other) const {
  const Sample a = sample(place, branch);
  const Sample b = sample(place, other);
  const std::uint64_t same = (a.row.below & b.row.below) | (a.row.above & b.row.above);
  return (same >> a.lane & kFirstLanes) != 0;
}

void NearestOnCurve::look_beyond_folds() {
  for (const int side : {-1, 1}) {
    std::uint64_t places = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      places |= far_[i] & (side < 0 ? behind(none_[i]) : before(none_[i]));
    }
    for (; places != 0; places &= places - 1) look_beyond(__builtin_ctzll(places), side);
  }
}

void NearestOnCurve::look_beyond(int end, int side) {
  const double value = places_.value(end);
  if (least_move(value) - margin_of_step() > best()) return;
  // Both that may merge have to be looked at, and joints that are far beyond the same limit at both
  // stay there. Each has three that differ from it in one sign.
  struct Pair {
    int branch, other;
  };
  std::array<Pair, std::size_t{3} * kCount / 2> pairs{};
  std::size_t size = 0;
  for (int branch = 0; branch < kCount; ++branch) {
    if (is_none(end, branch) || !is_none(end + side, branch)) continue;
    for (const int sign : {1, 2, 4}) {
      const int other = branch ^ sign;
      if (other < branch || is_none(end, other) || !is_none(end + side, other)) continue;
      if (exists(end, branch) && exists(end, other)) continue;
      if (!are_beyond(end, branch, other)) pairs[size++] = {branch, other};
    }
  }
  if (size == 0) return;
  branches_.solve_all(value);
  std::array<BranchPoint, kCount> points;
  for (int lane = 0; lane < kCount; ++lane) {
    points[static_cast<std::size_t>(lane)] = branches_.point(lane);
  }
  std::array<bool, kCount> worth{};
  for (std::size_t k = 0; k < size; ++k) {
    const auto [branch, other] = pairs[k];
    const auto a = static_cast<std::size_t>(branch);
    const auto b = static_cast<std::size_t>(other);
    if ((worth[a] && worth[b]) || branches_.least(branch) < 0 || branches_.least(other) < 0)
      continue;
    if (!bounds().may_be_shorter(points[a], points[b], places_.step, best())) continue;
    worth[a] = worth[b] = true;
  }
  for (int branch = 0; branch < kCount; ++branch) {
    const auto i = static_cast<std::size_t>(branch);
    if (!worth[i] || exists(end, branch)) continue;
    SweptBranches::Fold fold{value, value + side * places_.step};
    if (!narrow_where_shorter(branch, points[i], fold)) continue;
    branches_.narrow(branch, 1, fold);
    look_into_fold(branch, value, fold);
  }
}

bool NearestOnCurve::narrow_where_shorter(int branch, const BranchPoint& inside,
                                          SweptBranches::Fold& fold) {
  const double from = fold.inside;
  const double step = (fold.outside - from) / (kCount + 1);
  branches_.solve_one(branch, [&](int lane) { return from + step * (lane + 1); });
  bool may_be = best() == kInfinity;
  BranchPoint last = inside;
  MoveBounds::Way way{kInfinity, kInfinity};
  int lane = 0;
  for (; lane < kCount && branches_.least(lane) >= 0; ++lane) {
    const BranchPoint here = branches_.point(lane);
    way = bounds().way(last, here);
    may_be = may_be || bounds().may_be_shorter(last, here, way, best());
    last = here;
    fold.before = fold.inside;
    fold.least_before = fold.least_inside;
    fold.inside = branches_.value(lane);
    fold.least_inside = branches_.least(lane);
  }
  if (lane < kCount) {
    fold.outside = branches_.value(lane);
    fold.least_outside = branches_.least(lane);
  }
  // Joints go on as the root of the way to the fold (python -m bench moves; 20 costs too much).
  constexpr double kAtMost = 4;
  return may_be ||
         (last.loose - kAtMost * way.move < best() && last.off - kAtMost * way.largest <= 0);
}

void NearestOnCurve::look_into_fold(int branch, double inside, SweptBranches::Fold& fold) {
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    const double end = fold.end();
    const bool is_above = end > inside;
    const BranchSpan span{branch, std::min(inside, end), std::max(inside, end), !is_above,
                          is_above};
    const Ends ends = look_into(span, kDeepest);
    if (!(is_above ? ends.above : ends.below)) return;
    inside = fold.inside;
    branches_.narrow(branch, 1, fold);
  }
}

void NearestOnCurve::look_for_loops() {
  std::array<std::uint64_t, kCount> highest;
  std::uint64_t places = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    // What follows the last of a pack may be lower.
    highest[i] = none_[i] & rising_[i] & (~before(rising_[i]) | kLastLanes);
    places |= highest[i];
  }
  for (; places != 0; places &= places - 1) {
    const int place = __builtin_ctzll(places);
    // Those that were looked at, and are not.
    std::array<int, kCount> missing{};
    auto end = missing.begin();
    for (int branch = 0; branch < kCount; ++branch) {
      if ((highest[static_cast<std::size_t>(branch)] >> place & 1U) == 0) continue;
      // Branches that differ in what there is none of are equally far from being.
      const auto is_as_far = [&](int other) { return are_as_far(place, branch, other); };
      if (std::any_of(missing.begin(), end, is_as_far)) continue;
      if (!look_for_loop(place, branch)) *end++ = branch;
    }
  }
}

bool NearestOnCurve::are_as_far(int place, int branch, int other) const {
  for (const int side : {-1, 0, 1}) {
    if (is_known(place + side) && least(place + side, branch) != least(place + side, other)) {
      return false;
    }
  }
  return true;
}

bool NearestOnCurve::look_for_loop(int place, int branch) {
  const double value = places_.value(place);
  const auto known = [&](int at) { return is_known(at) ? least(at, branch) : -kInfinity; };
  const double here = least(place, branch);
  double below = known(place - 1);
  double above = known(place + 1);
  if (below == -kInfinity) below = above;
  if (above == -kInfinity) above = below;
  if (!may_be_between(below, here, above)) return false;
  if (least_move(value) - margin_of_step() > best()) return false;
  const SweptBranches::Loop loop =
      branches_.find_loop(branch, branches_.clamp(value - places_.step),
                          branches_.clamp(value + places_.step), below, above);
  if (loop.inside == kInfinity) return false;
  // Rounds of eight values in which a fold is looked for.
  constexpr int kFoldRounds = 2;
  const auto find_end = [&](double outside) {
    SweptBranches::Fold fold{loop.inside, outside};
    branches_.narrow(branch, kFoldRounds, fold);
    return fold.end();
  };
  const double lower = find_end(loop.below);
  const BranchSpan span{branch, lower, find_end(loop.above), true, true};
  look_into(span, kDeepest);
  return true;
}

}  // namespace iksel
