// SPDX-License-Identifier: BSD-3-Clause
// What is near may lie between samples: where the wrist is all but straight, other joints turn a
// lot from one sample to the next; and where a joint meets a limit, the nearest image is another
// one from there on.
#include <algorithm>
#include <array>
#include <cstdint>

#include "seeds/least_cost.hpp"
#include "seeds/nearest_on_curve.hpp"

namespace iksel {

void NearestOnCurve::look_between_samples(int branch) {
  const auto i = static_cast<std::size_t>(branch);
  const std::uint64_t here = exist_[i];
  const std::uint64_t any = here | far_[i];
  const std::uint64_t within = here | within_[i];
  for (std::uint64_t both =
           any & behind(any) & (within | behind(within)) & ~behind(find_staying(branch));
       both != 0; both &= both - 1) {
    look_before(__builtin_ctzll(both), branch);
  }
  for (std::uint64_t firsts = here & ~behind(here); firsts != 0; firsts &= firsts - 1) {
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

std::uint64_t NearestOnCurve::find_staying(int branch) const {
  std::uint64_t all = 0;
  for (int pack = 0; pack < kPacks; ++pack) {
    const SamplePack& here = packs_[static_cast<std::size_t>(pack)];
    if (!here.is_solved) continue;
    const lanes::BranchRow& row = here.branch[branch];
    const int next_pack = places_.find((pack + 1) * kCount) / kCount;
    const SamplePack& next = packs_[static_cast<std::size_t>(next_pack)];
    const auto stay = [&](std::uint64_t bits, std::uint64_t next_bits) {
      return bits & ((bits >> 1 & ~kLastLanes) | (next_bits & kFirstLanes) << (kCount - 1));
    };
    const bool is_next = next.is_solved;
    std::uint64_t bits = stay(row.below, is_next ? next.branch[branch].below : 0) |
                         stay(row.above, is_next ? next.branch[branch].above : 0);
    bits |= bits >> 32;
    bits |= bits >> 16;
    bits |= bits >> 8;
    all |= (bits & 0xff) << (pack * kCount);
  }
  return all;
}

void NearestOnCurve::look_before(int place, int branch) {
  // How much more than the swept one other joints turn from one sample to the next.
  constexpr double kSteeper = 4;
  const Sample before = sample(place - 1, branch);
  const Sample here = sample(place, branch);
  const bool is_far = before.is_far() || here.is_far();
  if (is_far && std::min(before.loose(), here.loose()) - kFarther >= best()) return;
  const BranchPoint a = point(before);
  const BranchPoint b = point(here);
  const bool may_be =
      is_far ? bounds().may_be_shorter(a, b, 0, best())
             : bounds().may_hide_shorter(a, b, bounds().way(a, b), kSteeper * places_.step, best());
  if (!may_be) return;
  const double value = places_.value(place);
  look_into({branch, value - places_.step, value, false, false}, kDeepest);
}

NearestOnCurve::Ends NearestOnCurve::look_into(const BranchSpan& span, int depth) {
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
    if (spans_left_ == 0) break;
    --spans_left_;
    look_into({span.branch, span.value(part(i)), span.value(part(i + 1)), false, false}, depth - 1);
  }
  const auto gets_shorter = [&](const BranchPoint& end, const BranchPoint& before,
                                const MoveBounds::Way& way) {
    return cost(end) <= cost(before) && may_lead_to_shorter(cost(end), way);
  };
  return {gets_shorter(nodes.front(), nodes[1], ways.front()),
          gets_shorter(nodes.back(), nodes[kCount - 2], ways.back())};
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
