// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/move_bounds.hpp"

namespace iksel {
namespace {

/// Of what turns so far it is not known which way round [rad].
constexpr double kEitherWay = 2.5;

}  // namespace

template <typename Beyond>
MoveBounds::Reach MoveBounds::between(const BranchPoint& a, const BranchPoint& b,
                                      const Beyond& beyond, double best) const {
  // Sums of joints are not looked at one by one.
  bool meets_limit = form_.sums != nullptr && (a.off > 0) != (b.off > 0);
  Norm norm(form_);
  for (std::size_t i = 0; i < a.q.size(); ++i) {
    const double turn = this->turn(i, a.q[i], b.q[i]);
    if (std::isnan(turn)) continue;
    const bool is_either_way = form_.turns[i] && std::abs(turn) > kEitherWay;
    const double around = is_either_way ? kPi : beyond(i, std::abs(turn));
    const Reach one = reach(i, a.q[i] + std::min(turn, 0.0) - around,
                            a.q[i] + std::max(turn, 0.0) + around, form_.margin);
    norm.add(i, one.move);
    if (!norm.is_below(best)) return {kInfinity, false};
    meets_limit = meets_limit || one.meets_limit;
  }
  return {norm.value(), meets_limit};
}

MoveBounds::Reach MoveBounds::between(const BranchPoint& a, const BranchPoint& b, const Way& way,
                                      double best) const {
  // Joints may turn so much beyond both points, as a part of what they turn between them, and of
  // what the one does that turns most.
  constexpr double kBeyond = 0.25;
  constexpr double kBend = 0.05;
  const double bend = kBend * way.largest;
  return between(
      a, b, [=](std::size_t, double turn) { return kBeyond * turn + bend; }, best);
}

bool MoveBounds::may_hide_shorter(const BranchPoint& a, const BranchPoint& b, const Way& way,
                                  double usual, double best) const {
  constexpr double kFinest = 1e-5;  // [rad]
  const bool is_wide = way.largest > std::max(kWide, usual);
  const bool changes_images = way.leaves_limits || a.is_blocked() || b.is_blocked();
  if (way.largest < kFinest || !(is_wide || changes_images)) return false;
  // Where joints turn far, what is shortest may be far from both points.
  if (!is_wide && !may_be_shorter(a, b, way, best - kTooLittle)) return false;
  const Reach between = this->between(a, b, way, best - kTooLittle);
  return (is_wide || between.meets_limit) && between.move < kInfinity;
}

bool MoveBounds::may_be_shorter(const Gap& gap, double best) const {
  const BranchPoint& a = gap.a;
  const BranchPoint& b = gap.b;
  const auto most = [&](const auto& change) {
    double largest = change(a, b);
    if (gap.before != nullptr) largest = std::max(largest, change(*gap.before, a));
    if (gap.behind != nullptr) largest = std::max(largest, change(b, *gap.behind));
    return largest;
  };
  const double rise = most([](const BranchPoint& from, const BranchPoint& to) {
    return std::abs(to.least - from.least);
  });
  if (!may_be_between(a.least, b.least, rise)) return false;
  // What joints a loop opens to, its ends do not tell, nor the only point that is on it.
  const auto may_be = [](const BranchPoint* point) { return point == nullptr || point->exists(); };
  if (may_be(gap.before) + may_be(&a) + may_be(&b) + may_be(gap.behind) < 2) return true;
  // A joint turns as far beyond two points as from one point to the next (python -m bench moves),
  // and where the branch ends as the root of how far that exists.
  const double at_end = std::sqrt(std::max(a.least, b.least));
  const auto turns_beyond = [&](std::size_t i) {
    const double turned = most([&](const BranchPoint& from, const BranchPoint& to) {
      const double one = std::abs(turn(i, from.q[i], to.q[i]));
      return std::isnan(one) ? 0.0 : one;
    });
    return turned + at_end;
  };
  // Where a branch ends as axes 4 and 6 are all but in line, their joints turn against each other
  // by any angle.
  const auto may_be_straight = [&] {
    const double bent = a.q[4] - straight_;
    const double bends = turn(4, a.q[4], b.q[4]);
    const double around = turns_beyond(4);
    return std::floor((bent + std::max(bends, 0.0) + around) / kPi) >
           std::floor((bent + std::min(bends, 0.0) - around) / kPi);
  };
  const bool is_straight = a.exists() != b.exists() && may_be_straight();
  const auto beyond = [&](std::size_t i, double /*turn*/) {
    return is_straight && (i == 3 || i == 5) ? kPi : turns_beyond(i);
  };
  return between(a, b, beyond, best - kTooLittle).move < kInfinity;
}

double MoveBounds::inside_move(const Joints& q) const {
  Norm norm(form_);
  for (std::size_t i = 0; i < q.size(); ++i) norm.add(i, reach(i, q[i], q[i], 0).move);
  return norm.value();
}

BranchPoint MoveBounds::nearest_on_swing(const BranchPoint& from, Joints turns) const {
  const BranchPoint nearest = nearest_on_line(from.q, turns);
  for (double& one : turns) {
    if (std::abs(one) > kStill) one -= std::copysign(kTwoPi, one);
  }
  BranchPoint around = nearest_on_line(from.q, turns);
  if (!(around.inside < nearest.inside)) around = nearest;
  // By whole turns inside the limits, as branches are.
  for (std::size_t i = 0; i < turns.size(); ++i) {
    double& q = around.q[i];
    if (form_.turns[i] && q > form_.upper[i]) {
      q -= kTwoPi * std::ceil((q - form_.upper[i]) / kTwoPi);
    } else if (form_.turns[i] && q < form_.lower[i]) {
      q += kTwoPi * std::ceil((form_.lower[i] - q) / kTwoPi);
    }
  }
  return around;
}

BranchPoint MoveBounds::nearest_on_line(const Joints& from, const Joints& turns) const {
  constexpr int kSteps = 64;
  constexpr int kRounds = 3;
  BranchPoint best{from, 0, 0, kInfinity, 0};
  double middle = 0.5;
  double width = 0.5;
  for (int round = 0; round < kRounds; ++round) {
    const double first = std::max(middle - width, 0.0);
    width = (std::min(middle + width, 1.0) - first) / kSteps;
    for (int step = 0; step <= kSteps; ++step) {
      const double part = first + width * step;
      Joints q = from;
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
