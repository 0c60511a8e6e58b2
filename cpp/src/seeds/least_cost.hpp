// SPDX-License-Identifier: BSD-3-Clause
// The least of a cost along a branch of a swept joint.
#pragma once

#include <algorithm>

#include "seeds/swept_branches.hpp"

namespace iksel {

/// Where to look for the least of a branch's costs.
struct Bracket {
  int branch;
  double middle, width;  ///< up to so far to both sides
  int rounds;            ///< of eight places each, at most
  double finest = 0;     ///< less far than this it need not be looked
  /// Whether the cost is smooth but for where the branch ends: a parabola then tells where it is
  /// least.
  bool is_smooth = false;
  /// The cost in the middle, where it is known.
  double in_middle = kInfinity;
};

/// Looks for the least of `cost(lane)` of a branch, each round around the least so far, where
/// `value(place)` is the swept joint's, after `branches.solve_one` of eight such. Calls
/// `found(lane, place)` with each that is the least so far; returns the least cost. The search ends
/// early where `is_enough(cost)`; a cost from `no_cost` on is none.
template <typename Branches, typename Value, typename Cost, typename Found, typename IsEnough>
double minimize(Branches& branches, const Bracket& bracket, const Value& value, const Cost& cost,
                double no_cost, const Found& found, const IsEnough& is_enough) {
  constexpr int kCount = SweptBranches::kCount;
  double least = bracket.in_middle;
  double middle = bracket.middle;
  double width = bracket.width;
  // A guess is looked at closely; where it fails, the bracket is that of before.
  bool guessed = false;
  double at = middle;
  double behind = width;
  for (int round = 0; round < bracket.rounds && width > bracket.finest; ++round) {
    if (is_enough(least, round)) break;
    const double spacing = 2 * width / (kCount + 1);
    const auto place = [&](int lane) { return middle - width + spacing * (lane + 1); };
    branches.solve_one(bracket.branch, [&](int lane) { return value(place(lane)); });
    SweptBranches::Row costs;
    for (int lane = 0; lane < kCount; ++lane) costs[static_cast<std::size_t>(lane)] = cost(lane);
    const auto best =
        static_cast<int>(std::min_element(costs.begin(), costs.end()) - costs.begin());
    const double here = costs[static_cast<std::size_t>(best)];
    const bool is_inside = best > 0 && best < kCount - 1;
    if (here < least) {
      least = here;
      found(best, place(best));
      middle = at = place(best);
    }
    if (guessed && !(here == least && is_inside)) {
      // The guess was wrong.
      middle = at;
      width = behind;
      guessed = false;
      continue;
    }
    width = behind = spacing;
    guessed = false;
    if (!is_inside || !bracket.is_smooth) continue;
    const double left = costs[static_cast<std::size_t>(best - 1)];
    const double right = costs[static_cast<std::size_t>(best + 1)];
    const double curvature = left - 2 * here + right;
    if (!(left < no_cost && right < no_cost && curvature > 0)) continue;
    // What is left to be gained is not worth another round.
    constexpr double kGain = 1e-8;
    if ((left - right) * (left - right) <= 8 * kGain * curvature * here) break;
    middle += 0.5 * (left - right) / curvature * spacing;
    width = 0.2 * spacing;
    guessed = true;
  }
  return least;
}

}  // namespace iksel
