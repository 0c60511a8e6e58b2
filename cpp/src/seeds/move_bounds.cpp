// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/move_bounds.hpp"

namespace iksel {

bool MoveBounds::may_hide_shorter(const BranchPoint& a, const BranchPoint& b, const Way& way,
                                  double usual, double best) const {
  constexpr double kWide = 0.7;     // [rad]
  constexpr double kFinest = 1e-5;  // [rad]
  // What is shorter by less is not looked for [rad].
  constexpr double kGain = 1e-3;
  const bool is_wide = way.largest > std::max(kWide, usual);
  if (!is_wide && !way.leaves_limits) {
    if (!a.is_blocked() && !b.is_blocked()) return false;
    // As long as the images stay the same, the moves change no more than that.
    const bool changes = std::abs(a.inside - b.inside) > kCurved * way.move;
    if (a.off <= 0 && b.off <= 0 && !changes) return false;
  }
  if (way.largest < kFinest || !may_be_shorter(a, b, way, best - kGain)) return false;
  const Reach between = this->between(a, b, 0);
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
  Norm norm(form_);
  for (std::size_t i = 0; i < q.size(); ++i) norm.add(i, reach(i, q[i], q[i], 0).move);
  return norm.value();
}

BranchPoint MoveBounds::nearest_between(const BranchPoint& a, const BranchPoint& b) const {
  // What turns by less does not take part in the swing [rad].
  constexpr double kStill = 0.1;
  std::array<double, 7> turns{};
  for (std::size_t i = 0; i < turns.size(); ++i) turns[i] = turn(i, a.q[i], b.q[i]);
  const BranchPoint nearest = nearest_on_line(a.q, turns);
  for (double& one : turns) {
    if (std::abs(one) > kStill) one -= std::copysign(kTwoPi, one);
  }
  const BranchPoint around = nearest_on_line(a.q, turns);
  return around.inside < nearest.inside ? around : nearest;
}

BranchPoint MoveBounds::nearest_on_line(const std::array<double, 7>& from,
                                        const std::array<double, 7>& turns) const {
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
      for (std::size_t i = 0; i < q.size(); ++i) q[i] += part * turns[i];
      const double move = inside_move(q);
      if (move >= best.inside) continue;
      best.q = q;
      best.inside = move;
      middle = part;
    }
  }
  return best;
}

MoveBounds::Reach MoveBounds::between(const BranchPoint& a, const BranchPoint& b,
                                      double slack) const {
  // Joints may turn so much beyond both points, as a part of what they turn from one to the other.
  constexpr double kBeyond = 0.25;
  // From here on it is not known which way round [rad].
  constexpr double kEitherWay = 2.5;
  // Sums of joints are not looked at one by one.
  bool meets_limit = form_.sums != nullptr && (a.off > 0) != (b.off > 0);
  Norm norm(form_);
  for (std::size_t i = 0; i < a.q.size(); ++i) {
    const double turn = this->turn(i, a.q[i], b.q[i]);
    if (std::isnan(turn)) continue;
    const bool is_either_way = form_.turns[i] && std::abs(turn) > kEitherWay;
    const double around = is_either_way ? kPi : kBeyond * std::abs(turn) + slack;
    const Reach one = reach(i, a.q[i] + std::min(turn, 0.0) - around,
                            a.q[i] + std::max(turn, 0.0) + around, form_.margin);
    if (one.move == kInfinity) return {kInfinity, false};
    norm.add(i, one.move);
    meets_limit = meets_limit || one.meets_limit;
  }
  return {norm.value(), meets_limit};
}

MoveBounds::Reach MoveBounds::reach(std::size_t joint, double low, double high,
                                    double outside) const {
  const double near = form_.from[joint];
  Reach reach{kInfinity, false};
  const auto take_image = [&](double by) {
    const double from = std::max(low + by, form_.lower[joint] - outside);
    const double to = std::min(high + by, form_.upper[joint] + outside);
    if (from > to) return;
    reach.move = std::min(reach.move, std::max({from - near, near - to, 0.0}));
    reach.meets_limit = reach.meets_limit || from > low + by || to < high + by;
  };
  if (!form_.turns[joint]) {
    take_image(0);
    return reach;
  }
  // The image whose middle is nearest, and those beside it.
  const double middle = 0.5 * (low + high) - near;
  const double by = without_turns(middle) - middle;
  for (const double image : {by - kTwoPi, by, by + kTwoPi}) take_image(image);
  return reach;
}

}  // namespace iksel
