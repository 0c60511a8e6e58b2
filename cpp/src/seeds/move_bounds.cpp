// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/move_bounds.hpp"

namespace iksel {
namespace {

/// Of what turns so far it is not known which way round [rad].
constexpr double kEitherWay = 2.5;

}  // namespace

bool MoveBounds::may_hide_shorter(const Gap& gap, double best) const {
  const BranchPoint& a = gap.a;
  const BranchPoint& b = gap.b;
  const auto known = [](const BranchPoint* point) {
    return point != nullptr ? point->least : lanes::kUnknown;
  };
  const double bend =
      beyond(b.least - a.least, a.least - known(gap.before), known(gap.behind) - b.least);
  if (std::max(a.least, b.least) + bend < 0) return false;
  // What joints a loop opens to, its ends do not tell, nor the only point that is on it.
  const auto may_be = [](const BranchPoint* point) { return point == nullptr || point->exists(); };
  if (may_be(gap.before) + may_be(&a) + may_be(&b) + may_be(gap.behind) < 2) return true;
  const bool ends = std::min(a.least, b.least) <= bend;
  const unsigned swinging = ends && std::max(a.least, b.least) >= 0 ? this->swinging(gap) : 0;
  // Sums of joints are not looked at one by one.
  bool hides = ends || a.is_far() || b.is_far() || form_.sums != nullptr;
  Norm norm(form_);
  for (std::size_t i = 0; i < a.q.size(); ++i) {
    Range range = this->range(gap, i, ends);
    if (std::isnan(range.low)) continue;
    if ((swinging >> i & 1U) != 0) range = {range.low - kPi, range.high + kPi};
    const Reach one = reach(i, range.low, range.high, form_.margin);
    norm.add(i, one.move);
    if (!norm.is_below(best - kTooLittle)) return false;
    hides = hides || one.meets_limit || range.high - range.low > kWide;
  }
  return hides;
}

bool MoveBounds::may_be_shorter(const BranchPoint& a, const BranchPoint& b, const Way& way,
                                double best) const {
  /// The curve is longer than a straight line by no more than half as much again.
  constexpr double kCurved = 1.5;
  if (!a.exists() || !b.exists() || way.largest > kWide) return true;
  // Where limits keep no joint from its nearest image, nor lie between both, they matter to
  // neither; and where joints turn by less, an answer is not nearer than those beside it.
  if (!(way.leaves_limits || a.is_blocked() || b.is_blocked())) return false;
  if (way.largest < form_.margin) return false;
  const double loose = way.leaves_limits ? 2 * std::min(a.loose, b.loose) : a.loose + b.loose;
  return loose - kCurved * way.move <= 2 * (best - kTooLittle) &&
         a.off + b.off - kCurved * way.largest <= 0;
}

MoveBounds::Range MoveBounds::range(const Gap& gap, std::size_t i, bool ends) const {
  const auto change = [&](const BranchPoint* from, const BranchPoint* to) {
    if (from == nullptr || to == nullptr) return lanes::kUnknown;
    return turn(i, from->q[i], to->q[i]);
  };
  const double d = change(&gap.a, &gap.b);
  const double before = change(gap.before, &gap.a);
  const double behind = change(&gap.b, gap.behind);
  double around = beyond(d, before, behind);
  if (!gap.exists()) {
    // A joint turns back as far as from one point to the next (python -m bench moves).
    around = std::abs(d);
    if (std::abs(before) > around) around = std::abs(before);
    if (std::abs(behind) > around) around = std::abs(behind);
  }
  // Where the branch ends, joints turn as the root of how far that exists.
  if (ends) around += std::sqrt(std::max({gap.a.least, gap.b.least, 0.0}));
  if (form_.turns[i] && std::abs(d) > kEitherWay) around = kPi;
  // Two joints that meet limits at one place may do so but for rounding.
  around += form_.margin;
  const double from = gap.a.q[i];
  return {from + std::min(d, 0.0) - around, from + std::max(d, 0.0) + around};
}

unsigned MoveBounds::swinging(const Gap& gap) const {
  unsigned swinging = 0;
  for (std::size_t i = 0; i < straight_.size(); ++i) {
    if (std::isnan(straight_[i])) continue;
    const Range range = this->range(gap, i, /*ends=*/true);
    // Written so that NaN is nowhere.
    const double low = std::floor((range.low - straight_[i]) / kPi);
    const double high = std::floor((range.high - straight_[i]) / kPi);
    // The swept joint, which is the last here, is before the first; it turns by what is known.
    if (high > low) swinging |= (i > 0 ? 5U << (i - 1) : 2U);
  }
  return swinging;
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
