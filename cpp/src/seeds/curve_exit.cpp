// SPDX-License-Identifier: BSD-3-Clause
// Where self-motions leave the limits.
#include <algorithm>
#include <array>
#include <cmath>

#include "seeds/curve_walker.hpp"

namespace iksel {
namespace {

/// A cubic by its values and slopes at 0 and 1.
struct Cubic {
  double from, slope_from, to, slope_to;

  [[nodiscard]] double operator()(double s) const {
    const double way = to - from;
    const double rest = 1 - s;
    return from + s * s * (3 - 2 * s) * way + s * rest * (rest * slope_from - s * slope_to);
  }
  /// Where it turns round between 0 and 1: 0, 1 or 2 places.
  int turns(std::array<double, 2>& places) const {
    const double a = 3 * (slope_from + slope_to - 2 * (to - from));
    const double b = 2 * (3 * (to - from) - 2 * slope_from - slope_to);
    int count = 0;
    const auto add = [&](double s) {
      if (s > 0 && s < 1) places[static_cast<std::size_t>(count++)] = s;
    };
    const double root = b * b - 4 * a * slope_from;
    if (root < 0) return 0;
    const double half = -0.5 * (b + std::copysign(std::sqrt(root), b));
    if (half != 0) add(slope_from / half);
    if (a != 0) add(half / a);
    if (count == 2 && places[0] > places[1]) std::swap(places[0], places[1]);
    return count;
  }
};

}  // namespace

CurveWalker::Joints CurveWalker::Step::at(double part) const {
  Joints q;
  for (std::size_t j = 0; j < kCurveJoints; ++j) {
    q[j] = Cubic{from.q[j], way * from.tangent[j], to.q[j], way * to.tangent[j]}(part);
  }
  return q;
}

CurveWalker::Exit CurveWalker::exit(const Step& step) const {
  Exit first{2, {}, nullptr};
  for (const Limit& limit : limits_) look_at_limit(limit, step, first);
  return first;
}

void CurveWalker::look_at_limit(const Limit& limit, const Step& step, Exit& first) {
  const Cubic value{limit.value(step.from.q.data()),
                    step.way * limit.value(step.from.tangent.data()), limit.value(step.to.q.data()),
                    step.way * limit.value(step.to.tangent.data())};
  // Far from it, nothing is to be looked for between.
  const double room = std::min({value.from - limit.lower, limit.upper - value.from,
                                value.to - limit.lower, limit.upper - value.to});
  if (room > 0.5 * (std::abs(value.slope_from) + std::abs(value.slope_to))) return;
  std::array<double, 2> turns{};
  const int count = value.turns(turns);
  for (int i = 0; i <= count; ++i) {
    double outside = i < count ? turns[static_cast<std::size_t>(i)] : 1;
    const double at = value(outside);
    if (limit.beyond(at) <= kAtLimit) continue;
    const bool at_upper = at > limit.upper;
    double inside = i > 0 ? turns[static_cast<std::size_t>(i - 1)] : 0;
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (inside + outside);
      const bool is_out = at_upper ? value(middle) > limit.upper : value(middle) < limit.lower;
      (is_out ? outside : inside) = middle;
    }
    if (inside >= first.part) return;
    first = {inside, {ArcEnd::limit, limit.joint, at_upper, limit.coupled_limit}, &limit};
    return;
  }
}

CurveWalker::Place CurveWalker::leave(const Step& step, const Exit& exit) {
  /// Where a curve runs along the limit, it is left as it is.
  constexpr double kAlong = 0.05;
  Place at{step.at(exit.part), {}};
  const double value = exit.at.at_upper ? exit.limit->upper : exit.limit->lower;
  for (int round = 0; round < 3; ++round) {
    orient(&at, 1);
    const double slope = exit.limit->value(at.tangent.data());
    if (!(std::abs(slope) > kAlong)) break;
    const double way = (value - exit.limit->value(at.q.data())) / slope;
    for (std::size_t j = 0; j < kCurveJoints; ++j) at.q[j] += way * at.tangent[j];
  }
  return at;
}

}  // namespace iksel
