// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/move_bounds.hpp"

#include "base/angle.hpp"

namespace iksel {

bool MoveBounds::may_hide_shorter(const BranchPoint& a, const BranchPoint& b, double usual,
                                  double best) const {
  constexpr double kWide = 0.7;     // [rad]
  constexpr double kFinest = 1e-5;  // [rad]
  // What is shorter by less is not looked for [rad].
  constexpr double kGain = 1e-3;
  const Way way = this->way(a, b);
  const bool is_wide = way.largest > std::max(kWide, usual);
  if (!is_wide && !way.leaves_limits) {
    if (!a.is_blocked() && !b.is_blocked()) return false;
    // As long as the images stay the same, the moves change no more than that.
    const bool changes = std::abs(a.inside - b.inside) > kCurved * way.move;
    if (a.off <= 0 && b.off <= 0 && !changes) return false;
  }
  if (way.largest < kFinest || !may_be_shorter(a, b, way, best - kGain)) return false;
  const Between between = this->between(a, b, 0);
  return (is_wide || between.meets_limit) && between.move < best - kGain;
}

bool MoveBounds::may_be_shorter(const BranchPoint& a, const BranchPoint& b, double slack,
                                double best) const {
  Way way = this->way(a, b);
  way.move += slack;
  way.largest += slack;
  return may_be_shorter(a, b, way, best) && between(a, b, slack).move < best;
}

double MoveBounds::inside_move(const std::array<double, 7>& q) const {
  double sum = 0;
  double largest = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    double least = kInfinity;
    const double d = q[i] - form_.from[i];
    const double by = form_.turns[i] ? without_turns(d) - d : 0;
    for (const double turns : {by - kTwoPi, by, by + kTwoPi}) {
      if (!form_.turns[i] && turns != 0) continue;
      const double image = q[i] + turns;
      if (image < form_.lower[i] || image > form_.upper[i]) continue;
      least = std::min(least, form_.weight[i] * std::abs(d + turns));
    }
    largest = std::max(largest, least);
    sum += least * least;
  }
  return form_.takes_largest ? largest : std::sqrt(sum);
}

BranchPoint MoveBounds::nearest_between(const BranchPoint& a, const BranchPoint& b) const {
  // What turns by less does not take part in the swing [rad].
  constexpr double kStill = 0.1;
  std::array<double, 7> turn{};
  for (std::size_t i = 0; i < turn.size(); ++i) {
    turn[i] = form_.turns[i] ? without_turns(b.q[i] - a.q[i]) : b.q[i] - a.q[i];
  }
  const BranchPoint nearest = nearest_on_line(a.q, turn);
  for (double& one : turn) {
    if (std::abs(one) > kStill) one -= std::copysign(kTwoPi, one);
  }
  const BranchPoint around = nearest_on_line(a.q, turn);
  return around.inside < nearest.inside ? around : nearest;
}

BranchPoint MoveBounds::nearest_on_line(const std::array<double, 7>& from,
                                        const std::array<double, 7>& turn) const {
  constexpr int kSteps = 64;
  constexpr int kRounds = 3;
  BranchPoint best{from, 0, kInfinity, 0};
  double middle = 0.5;
  double width = 0.5;
  for (int round = 0; round < kRounds; ++round) {
    const double first = std::max(middle - width, 0.0);
    width = (std::min(middle + width, 1.0) - first) / kSteps;
    for (int step = 0; step <= kSteps; ++step) {
      const double part = first + width * step;
      std::array<double, 7> q = from;
      for (std::size_t i = 0; i < q.size(); ++i) q[i] += part * turn[i];
      const double move = inside_move(q);
      if (move >= best.inside) continue;
      best.q = q;
      best.inside = move;
      middle = part;
    }
  }
  return best;
}

MoveBounds::Between MoveBounds::between(const BranchPoint& a, const BranchPoint& b,
                                        double slack) const {
  // Joints may turn so much beyond both points, as a part of what they turn from one to the other.
  constexpr double kBeyond = 0.25;
  // From here on it is not known which way round [rad].
  constexpr double kEitherWay = 2.5;
  // Sums of joints are not looked at one by one.
  Between between{0, form_.coupled != nullptr && (a.off > 0) != (b.off > 0)};
  double sum = 0;
  for (std::size_t i = 0; i < a.q.size(); ++i) {
    const double turn = form_.turns[i] ? without_turns(b.q[i] - a.q[i]) : b.q[i] - a.q[i];
    const bool is_either_way = form_.turns[i] && std::abs(turn) > kEitherWay;
    const double around = is_either_way ? kPi : kBeyond * std::abs(turn) + slack;
    const double low = a.q[i] + std::min(turn, 0.0) - around;
    const double high = a.q[i] + std::max(turn, 0.0) + around;
    double least = kInfinity;
    const auto take_image = [&](double by) {
      const double from = std::max(low + by, form_.lower[i] - form_.margin);
      const double to = std::min(high + by, form_.upper[i] + form_.margin);
      if (from > to) return;
      least = std::min(least, std::max({from - form_.from[i], form_.from[i] - to, 0.0}));
      between.meets_limit = between.meets_limit || from > low + by || to < high + by;
    };
    if (form_.turns[i]) {
      // The image whose middle is nearest, and those beside it.
      const double middle = 0.5 * (low + high) - form_.from[i];
      const double by = without_turns(middle) - middle;
      for (const double image : {by - kTwoPi, by, by + kTwoPi}) take_image(image);
    } else {
      take_image(0);
    }
    if (least == kInfinity) return {kInfinity, false};
    const double move = form_.weight[i] * least;
    between.move = std::max(between.move, move);
    sum += move * move;
  }
  if (!form_.takes_largest) between.move = std::sqrt(sum);
  return between;
}

}  // namespace iksel
