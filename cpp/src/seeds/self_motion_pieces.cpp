// SPDX-License-Identifier: BSD-3-Clause
// What of a branch's span lies inside the limits.
#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "seeds/least_cost.hpp"
#include "seeds/self_motion_arcs.hpp"

namespace iksel {
namespace {

/// At the end of a span rounding may take a branch out of being.
constexpr double kEndRounding = 1e-9;

/// A function's value at a place.
struct Point {
  double x, y;
};

/// What a function may come down to between b and c, if it goes on as it came from a before, and
/// as it goes to d behind; by two fifths more.
double lowest(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double width = c.x - b.x;
  const double down = b.x == a.x ? 0.0 : (a.y - b.y) / (b.x - a.x) * width;
  const double up = d.x == c.x ? 0.0 : (d.y - c.y) / (d.x - c.x) * width;
  constexpr double kMore = 1.4;
  if (!(down > 0)) return b.y;
  // Where it goes up no more behind c, all of the way down may be left until there.
  if (!(up > 0)) return b.y - kMore * down;
  const double part = (b.y - c.y + up) / (down + up);
  return b.y - kMore * down * std::min(std::max(part, 0.0), 1.0);
}

}  // namespace

SelfMotionArcs::Node SelfMotionArcs::node(int lane, double part) const {
  Node node;
  node.part = part;
  branches_.copy_joints(lane, node.q.data());
  node.beyond = branches_.least(lane) >= -kEndRounding ? beyond_limits(node.q) : kInfinity;
  return node;
}

double SelfMotionArcs::beyond_limits(const Joints& q) const {
  // Of joints with a whole turn or more, an image lies inside.
  double beyond = -kPi;
  if (!joints_.coupled.empty()) beyond = std::max(beyond, joints_.beyond_coupled(q.data()));
  for (int j = 0; j < SweptBranches::kDof; ++j) {
    if (joints_.is_periodic(j) || j == branches_.joint()) continue;
    const double at = q[static_cast<std::size_t>(j)];
    beyond = std::max(beyond, std::max(at - joints_.upper[j], joints_.lower[j] - at));
  }
  return beyond;
}

std::array<SelfMotionArcs::Node, SelfMotionArcs::kLanes> SelfMotionArcs::nodes_between(
    const BranchSpan& span, const Node& a, const Node& b) {
  const auto part = [&](int lane) {
    return a.part + (b.part - a.part) * (lane + 1) / (kLanes + 1);
  };
  branches_.solve_one(span.branch, [&](int lane) { return span.value(part(lane)); });
  std::array<Node, kLanes> between;
  for (int lane = 0; lane < kLanes; ++lane) {
    between[static_cast<std::size_t>(lane)] = node(lane, part(lane));
  }
  return between;
}

void SelfMotionArcs::sample(const BranchSpan& span, int count) {
  nodes_.clear();
  for (int first = 0; first < count; first += kLanes) {
    const auto part = [&](int lane) { return static_cast<double>(first + lane) / (count - 1); };
    branches_.solve_one(span.branch, [&](int lane) { return span.value(part(lane)); });
    for (int lane = 0; lane < kLanes; ++lane) nodes_.push_back(node(lane, part(lane)));
  }
}

void SelfMotionArcs::sample_densely(const BranchSpan& span) {
  /// Joints that turn farther between two nodes may be inside their limits on the way [rad].
  constexpr double kFar = 0.3;
  constexpr std::size_t kMostNodes = 2048;
  for (std::size_t i = 1; i < nodes_.size() && nodes_.size() < kMostNodes;) {
    const Node a = nodes_[i - 1];
    const Node b = nodes_[i];
    const double far = turn(a.q, b.q);
    constexpr double kNearest = 1e-7;
    const bool is_outside = std::min(a.beyond, b.beyond) > far;
    if (far <= kFar || is_outside || b.part - a.part < kNearest) {
      ++i;
      continue;
    }
    const std::array<Node, kLanes> between = nodes_between(span, a, b);
    nodes_.insert(nodes_.begin() + static_cast<std::ptrdiff_t>(i), between.begin(), between.end());
  }
}

double SelfMotionArcs::turn(const Joints& a, const Joints& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(without_turns(a[i] - b[i])));
  }
  return largest;
}

void SelfMotionArcs::sample_between(const BranchSpan& span) {
  const std::size_t count = nodes_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool inside = nodes_[i].beyond <= 0;
    const double sign = inside ? -1 : 1;
    const double here = sign * nodes_[i].beyond;
    const auto beside = [&](std::size_t k) {
      if (k >= count) return here;
      const bool is_behind_limits = jumps(nodes_[i].q, nodes_[k].q);
      return is_behind_limits ? here + turn(nodes_[i].q, nodes_[k].q) : sign * nodes_[k].beyond;
    };
    const double left = beside(i - 1);
    const double right = beside(i + 1);
    if (left < 0 || right < 0 || here > left || here > right) continue;
    const auto part_of = [&](std::size_t k) { return nodes_[std::min(k, count - 1)].part; };
    const auto bottom = [&](std::size_t behind, std::size_t ahead, std::size_t after) {
      return ahead >= count
                 ? here
                 : lowest({part_of(behind), beside(behind)}, {part_of(i), here},
                          {part_of(ahead), beside(ahead)}, {part_of(after), beside(after)});
    };
    const double lowest_ahead = bottom(i - 1, i + 1, i + 2);
    const double lowest_behind = bottom(i + 1, i - 1, i - 2);
    // Not far off, or beside a whole turn's jump, it is looked at anyway [rad].
    constexpr double kClose = 0.03;
    const bool jumped = (i > 0 && jumps(nodes_[i - 1].q, nodes_[i].q)) ||
                        (i + 1 < count && jumps(nodes_[i].q, nodes_[i + 1].q));
    if (std::min(lowest_ahead, lowest_behind) > 0 && !jumped && (inside || here > kClose)) continue;
    constexpr int kRounds = 6;
    Node found;
    const auto bounded = [](double part) { return std::min(std::max(part, 0.0), 1.0); };
    const auto value = [&](double part) { return span.value(bounded(part)); };
    const auto cost = [&](int lane) { return sign * node(lane, 0).beyond; };
    const auto take = [&](int lane, double part) { found = node(lane, bounded(part)); };
    const auto is_enough = [&](double so_far, int) { return inside ? so_far < 0 : so_far <= 0; };
    const double behind = i > 0 ? nodes_[i].part - nodes_[i - 1].part : 0.0;
    const double ahead = i + 1 < count ? nodes_[i + 1].part - nodes_[i].part : 0.0;
    const Bracket bracket{span.branch, nodes_[i].part, std::max(behind, ahead), kRounds, 0, true};
    const double least = minimize(branches_, bracket, value, cost, kInfinity, take, is_enough);
    if (is_enough(least, kRounds)) nodes_.push_back(found);
  }
  std::sort(nodes_.begin(), nodes_.end(),
            [](const Node& a, const Node& b) { return a.part < b.part; });
}

void SelfMotionArcs::cut(const BranchSpan& span) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].beyond > 0) continue;
    Piece piece;
    piece.span = span;
    if (i == 0) {
      piece.ends[0] = end_of_span(span, 0);
    } else {
      piece.nodes.push_back(find_end(span, nodes_[i], nodes_[i - 1].part, piece.ends[0]));
    }
    piece.nodes.push_back(nodes_[i]);
    while (i + 1 < nodes_.size() && nodes_[i + 1].beyond <= 0 &&
           !jumps(nodes_[i].q, nodes_[i + 1].q)) {
      piece.nodes.push_back(nodes_[++i]);
    }
    if (i + 1 == nodes_.size()) {
      piece.ends[1] = end_of_span(span, 1);
    } else {
      piece.nodes.push_back(find_end(span, nodes_[i], nodes_[i + 1].part, piece.ends[1]));
    }
    pieces_.push_back(std::move(piece));
  }
}

SelfMotionArcs::Node SelfMotionArcs::find_end(const BranchSpan& span, const Node& inside,
                                              double outside, SelfMotionEnd& end) {
  constexpr int kRounds = 7;
  Node last = inside;
  for (int round = 0; round < kRounds; ++round) {
    const double from = last.part;
    const double step = (outside - from) / (kLanes + 1);
    const auto part = [&](int lane) { return from + step * (lane + 1); };
    branches_.solve_one(span.branch, [&](int lane) { return span.value(part(lane)); });
    for (int lane = 0; lane < kLanes; ++lane) {
      const Node next = node(lane, part(lane));
      if (next.beyond > 0 || jumps(last.q, next.q)) {
        outside = next.part;
        end = next.beyond == kInfinity ? SelfMotionEnd{ArcEnd::fold} : culprit(last.q, next.q);
        break;
      }
      last = next;
    }
  }
  return last;
}

SelfMotionEnd SelfMotionArcs::culprit(const Joints& inside, const Joints& outside) const {
  SelfMotionEnd end{ArcEnd::limit, -1, false};
  double farthest = -kInfinity;
  for (int j = 0; j < SweptBranches::kDof; ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (joints_.is_periodic(j) || j == branches_.joint()) continue;
    const double above = outside[i] - joints_.upper[j];
    const double below = joints_.lower[j] - outside[i];
    // From beyond one limit to beyond the other: it is the one that was near.
    const bool turned = std::abs(outside[i] - inside[i]) > kPi;
    const double beyond = turned ? kPi : std::max(above, below);
    if (beyond <= farthest) continue;
    farthest = beyond;
    end.joint = j;
    end.at_upper = turned ? inside[i] > outside[i] : above > below;
  }
  for (const CoupledRow& row : joints_.coupled) {
    const double sum = row.sum(outside.data());
    if (row.beyond(sum) <= farthest) continue;
    farthest = row.beyond(sum);
    end.joint = -1;
    end.coupled_limit = row.given;
    end.at_upper = sum > 0.5 * (row.lower + row.upper);
  }
  return end;
}

SelfMotionEnd SelfMotionArcs::end_of_span(const BranchSpan& span, int side) const {
  if (side == 0 ? span.folds_below : span.folds_above) return {ArcEnd::fold};
  if (places_.turns) return {ArcEnd::closed};
  return {ArcEnd::limit, branches_.joint(), side == 1};
}

}  // namespace iksel
