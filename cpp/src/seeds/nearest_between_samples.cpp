// SPDX-License-Identifier: BSD-3-Clause
// What is near may lie between samples: where the wrist is all but straight, other joints turn a
// lot from one sample to the next; where a joint meets a limit, the nearest image is another one
// from there on; and where a branch ends, as it merges with another and the curve turns back,
// joints change as the root of the swept one. A loop has two such ends, maybe all of it between
// samples.
#include <algorithm>
#include <array>
#include <cstdint>

#include "seeds/nearest_on_curve.hpp"

namespace iksel {

void NearestOnCurve::look_between_samples() {
  // Those at one end of which a branch is.
  const auto ends = [&](std::size_t i) {
    const std::uint64_t any = exist_[i] | far_[i];
    return (any & behind(none_[i])) | (none_[i] & behind(any));
  };
  // What is found where branches exist bounds what is looked for where they end. Beside that joints
  // turn as the root of the swept one, farther than the samples tell.
  visit_gaps([&](std::size_t i) {
    const std::uint64_t any = exist_[i] | far_[i];
    const std::uint64_t within = exist_[i] | within_[i];
    return any & behind(any) & (within | behind(within) | behind(ends(i)) | before(ends(i))) &
           ~behind(find_staying(static_cast<int>(i)));
  });
  visit_gaps(ends);
  visit_gaps([&](std::size_t i) { return find_loops(static_cast<int>(i)); });
}

std::uint64_t NearestOnCurve::find_loops(int branch) const {
  // How far it is from being at the samples, at two before and one behind.
  std::array<double, kSamples + 3> far;
  for (int place = 0; place < kSamples; ++place) {
    const SamplePack& pack = packs_[static_cast<std::size_t>(place / lanes::kWidth)];
    far[static_cast<std::size_t>(place + 2)] =
        pack.is_solved ? pack.branch[branch].least[place % lanes::kWidth] : lanes::kUnknown;
  }
  far[0] = places_.turns ? far[kSamples] : lanes::kUnknown;
  far[1] = places_.turns ? far[kSamples + 1] : lanes::kUnknown;
  far[kSamples + 2] = places_.turns ? far[2] : lanes::kUnknown;

  const std::uint64_t none = none_[static_cast<std::size_t>(branch)];
  std::uint64_t loops = 0;
  for (std::uint64_t both = none & behind(none); both != 0; both &= both - 1) {
    const double* at = &far[static_cast<std::size_t>(__builtin_ctzll(both))];
    const double beyond = MoveBounds::beyond(at[2] - at[1], at[1] - at[0], at[3] - at[2]);
    if (std::max(at[1], at[2]) + beyond >= 0) loops |= both & (~both + 1);
  }
  return loops;
}

template <typename Places>
void NearestOnCurve::visit_gaps(const Places& places_of) {
  std::array<std::uint64_t, lanes::kWidth> places;
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < lanes::kWidth; ++i) all |= places[i] = places_of(i);
  for (; all != 0; all &= all - 1) {
    const int place = __builtin_ctzll(all);
    // How far they are from being, where branches were looked for and are not: those that differ in
    // what there is none of are equally far.
    std::array<double, lanes::kWidth> missing{};
    auto end = missing.begin();
    for (int branch = 0; branch < lanes::kWidth; ++branch) {
      if ((places[static_cast<std::size_t>(branch)] >> place & 1U) == 0) continue;
      const double a = point(place - 1, branch).least;
      const double b = point(place, branch).least;
      if (std::find(missing.begin(), end, a + b) != end) continue;
      const double value = places_.value(place);
      const bool is_farther = least_move(value) - margin_of_step() > best();
      if (is_farther || !may_hide_shorter(place, branch)) continue;
      const bool any = look_into({branch, value - places_.step, value}, kDeepest);
      if (!any && std::max(a, b) < 0) *end++ = a + b;
    }
  }
}

std::uint64_t NearestOnCurve::find_staying(int branch) const {
  std::uint64_t all = 0;
  for (int pack = 0; pack < static_cast<int>(packs_.size()); ++pack) {
    const SamplePack& here = packs_[static_cast<std::size_t>(pack)];
    if (!here.is_solved) continue;
    const lanes::BranchRow& row = here.branch[branch];
    const int next_pack = places_.find((pack + 1) * lanes::kWidth) / lanes::kWidth;
    const SamplePack& next = packs_[static_cast<std::size_t>(next_pack)];
    const auto stay = [&](std::uint64_t bits, std::uint64_t next_bits) {
      return bits & ((bits >> 1 & ~kLastLanes) | (next_bits & kFirstLanes) << (lanes::kWidth - 1));
    };
    const bool is_next = next.is_solved;
    std::uint64_t bits = stay(row.below, is_next ? next.branch[branch].below : 0) |
                         stay(row.above, is_next ? next.branch[branch].above : 0);
    bits |= bits >> 32;
    bits |= bits >> 16;
    bits |= bits >> 8;
    all |= (bits & 0xff) << (pack * lanes::kWidth);
  }
  return all;
}

bool NearestOnCurve::may_hide_shorter(int place, int branch) const {
  const BranchPoint a = point(place - 1, branch);
  const BranchPoint b = point(place, branch);
  if (!bounds().may_be_shorter(a, b, bounds().way(a, b), best())) return false;
  std::array<BranchPoint, 2> beside;
  const auto known = [&](int at, std::size_t i) {
    return is_known(at) ? &(beside[i] = point(at, branch)) : nullptr;
  };
  return bounds().may_hide_shorter({known(place - 2, 0), a, b, known(place + 1, 1)}, best());
}

bool NearestOnCurve::look_into(const BranchSpan& span, int depth) {
  /// Between two points that are all but the same: where the branch ends, joints turn less [rad].
  constexpr double kTurnsFar = 0.01;
  branches_.solve_one(span.branch, [&](int lane) { return span.value(lane); });
  std::array<BranchPoint, lanes::kWidth> nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = branches_.point(static_cast<int>(i));
  // From each node to the next.
  std::array<MoveBounds::Way, lanes::kWidth - 1> ways;
  for (std::size_t i = 0; i < ways.size(); ++i) ways[i] = bounds().way(nodes[i], nodes[i + 1]);

  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i > 0 && cost(nodes[i]) > cost(nodes[i - 1])) continue;
    if (i < ways.size() && cost(nodes[i]) > cost(nodes[i + 1])) continue;
    const MoveBounds::Way& before = ways[i > 0 ? i - 1 : 0];
    const MoveBounds::Way& behind = ways[std::min(i, ways.size() - 1)];
    const MoveBounds::Way widest{std::max(before.move, behind.move),
                                 std::max(before.largest, behind.largest)};
    // Where there is none, what is beside nodes is looked into.
    if (nodes[i].exists() && may_lead_to_shorter(cost(nodes[i]), widest)) {
      follow(span, static_cast<int>(i), widest);
    }
  }
  bool any =
      std::any_of(nodes.begin(), nodes.end(), [](const auto& node) { return node.exists(); });
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const BranchPoint& a = nodes[i];
    const BranchPoint& b = nodes[i + 1];
    if (!bounds().may_be_shorter(a, b, ways[i], best())) continue;
    const BranchPoint* before = i > 0 ? &nodes[i - 1] : nullptr;
    const BranchPoint* behind = i + 2 < nodes.size() ? &nodes[i + 2] : nullptr;
    if (!bounds().may_hide_shorter({before, a, b, behind}, best())) continue;
    if (ways[i].is_swing()) {
      is_in_doubt_ = true;
      const BranchPoint nearest = bounds().nearest_on_swing(a, branches_.turns(a, b));
      if (nearest.inside < best()) add(nearest);
      continue;
    }
    if (depth == 0 || spans_left_ == 0) {
      is_degenerate_ |= spans_left_ == 0 || ways[i].largest > kTurnsFar;
      continue;
    }
    --spans_left_;
    const int lane = static_cast<int>(i);
    any |= look_into({span.branch, span.value(lane), span.value(lane + 1)}, depth - 1);
  }
  return any;
}

bool NearestOnCurve::may_lead_to_shorter(double cost, const MoveBounds::Way& way) const {
  // What is the best so far is followed to its end.
  if (cost >= kRefused) return cost - kRefused < way.largest;
  return cost < best() || cost - way.move < best() - MoveBounds::kTooLittle;
}

void NearestOnCurve::follow(const BranchSpan& span, int node, const MoveBounds::Way& way) {
  add_least(span, span.value(node), span.spacing(), kNone, [&](double so_far, int round) {
    // Each round looks at less than a quarter of the way.
    const double part_of_way = 1.0 / (1 << 2 * round);
    return round > 0 &&
           !may_lead_to_shorter(so_far, {part_of_way * way.move, part_of_way * way.largest});
  });
}

}  // namespace iksel
