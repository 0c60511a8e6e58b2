// SPDX-License-Identifier: BSD-3-Clause
// Where the arcs of a self-motion leave the limits.
#include <algorithm>
#include <array>
#include <cmath>

#include "seeds/curve.hpp"

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

Curve::Joints Curve::Step::at(double part) const {
  Joints q;
  for (std::size_t j = 0; j < kDof; ++j) {
    q[j] = Cubic{from[j], way * tangent_from[j], to[j], way * tangent_to[j]}(part);
  }
  return q;
}

Curve::Exit Curve::exit(const Step& step) {
  Exit first{2, {}};
  for (const Limit& limit : limits_) look_at_limit(limit, step, first);
  return first;
}

void Curve::look_at_limit(const Limit& limit, const Step& step, Exit& first) {
  constexpr int kHalvings = 40;
  /// What a cubic may be off by [rad or m].
  constexpr double kDoubtful = 2e-3;
  const Cubic value{limit.value(step.from), step.way * limit.value(step.tangent_from),
                    limit.value(step.to), step.way * limit.value(step.tangent_to)};
  // Far from it, nothing is to be looked for between.
  const double room = std::min({value.from - limit.lower, limit.upper - value.from,
                                value.to - limit.lower, limit.upper - value.to});
  if (room > 0.5 * (std::abs(value.slope_from) + std::abs(value.slope_to))) return;
  const auto beyond = [&](double at) { return std::max(limit.lower - at, at - limit.upper); };
  std::array<double, 2> turns{};
  const int count = value.turns(turns);
  for (int i = 0; i <= count; ++i) {
    double outside = i < count ? turns[static_cast<std::size_t>(i)] : 1;
    const double at = value(outside);
    if (beyond(at) <= kAtLimit) continue;
    const bool is_doubtful = beyond(at) < kDoubtful;
    if (is_doubtful && beyond(limit.value(corrected(step.at(outside)))) <= kAtLimit) continue;
    const bool at_upper = at > limit.upper;
    double inside = i > 0 ? turns[static_cast<std::size_t>(i - 1)] : 0;
    for (int halving = 0; halving < kHalvings; ++halving) {
      const double middle = 0.5 * (inside + outside);
      const bool is_out = at_upper ? value(middle) > limit.upper : value(middle) < limit.lower;
      (is_out ? outside : inside) = middle;
    }
    if (inside >= first.part) return;
    first = {inside, limit.at};
    first.at.at_upper = at_upper;
    return;
  }
}

Curve::Joints Curve::corrected(const Joints& q) {
  constexpr int kRounds = 2;
  for (std::size_t j = 0; j < kDof; ++j) std::fill_n(probe_.q[j], kLanes, q[j]);
  for (int round = 0; round < kRounds; ++round) kernels_.orient_curves(chain_, probe_);
  Joints on_curve;
  for (std::size_t j = 0; j < kDof; ++j) on_curve[j] = probe_.q[j][0];
  return on_curve;
}

bool Curve::turn_round(Walk& walk, int lane, const Joints& next) {
  if (joints_.coupled_turning.empty()) return false;
  Joints image = next;
  joints_.wrap(image.data());
  if (!is_inside(image)) return false;
  for (std::size_t j = 0; j < kDof; ++j) pack_.q[j][lane] = image[j];
  walk.q.push_back(image);
  return true;
}

void Curve::leave(Walk& walk, const Joints& q, const SelfMotionEnd& at) {
  /// So near to where a walk leaves is its end [rad or m].
  constexpr double kSame = 0.03;
  End* end = nullptr;
  double nearest = kSame;
  for (End& each : ends_) {
    if (each.at.joint != at.joint || each.at.at_upper != at.at_upper) continue;
    if (!(walk.is_reversed ? each.leads_in : each.leads_out)) continue;
    const double away = joints_.distance(each.q, q);
    if (away >= nearest) continue;
    nearest = away;
    end = &each;
  }
  if (end == nullptr) {
    walk.q.push_back(q);
    finish(walk, at);
    return;
  }
  // Of two that come to one end, one has gone over where the curve is outside of a limit.
  if (end->is_taken) return;
  walk.q.push_back(end->q);
  end->is_taken = true;
  finish(walk, at);
}

}  // namespace iksel
