// SPDX-License-Identifier: BSD-3-Clause
// Pieces of branches joined to arcs where branches merge.
#include <algorithm>
#include <cmath>

#include "seeds/self_motion_arcs.hpp"

namespace iksel {

void SelfMotionArcs::join() {
  /// Branches that merge are so near to each other at the last value where they exist [rad].
  constexpr double kMerged = 0.05;
  const auto last = [](const Piece& piece, int side) {
    return side == 0 ? piece.nodes.front().q : piece.nodes.back().q;
  };
  const auto is_open = [](const Piece& piece, int side) {
    return piece.ends[side].kind != ArcEnd::limit && piece.next[side] < 0;
  };
  const int count = static_cast<int>(pieces_.size());
  for (int a = 0; a < 2 * count; ++a) {
    Piece& from = pieces_[static_cast<std::size_t>(a / 2)];
    if (!is_open(from, a % 2)) continue;
    double nearest = kMerged;
    int found = -1;
    for (int b = a + 1; b < 2 * count; ++b) {
      const Piece& to = pieces_[static_cast<std::size_t>(b / 2)];
      if (!is_open(to, b % 2) || to.ends[b % 2].kind != from.ends[a % 2].kind) continue;
      // A branch merges with another one; at the seam of a whole turn it goes on itself.
      const bool is_fold = from.ends[a % 2].kind == ArcEnd::fold;
      if (is_fold == (to.span.branch == from.span.branch)) continue;
      const double away = joints_.distance(last(from, a % 2), last(to, b % 2));
      if (away >= nearest) continue;
      nearest = away;
      found = b;
    }
    if (found < 0) continue;
    Piece& to = pieces_[static_cast<std::size_t>(found / 2)];
    from.next[a % 2] = found / 2;
    from.next_side[a % 2] = found % 2;
    to.next[found % 2] = a / 2;
    to.next_side[found % 2] = a % 2;
  }
}

void SelfMotionArcs::find_partners() {
  // A span that begins and ends beside another of its branch, between two samples, is found by the
  // branch that it merges with.
  constexpr double kBeside = 1e-3;
  // NOLINTNEXTLINE(modernize-loop-convert): the pieces become more.
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    for (int side = 0; side < 2; ++side) {
      if (pieces_[i].ends[side].kind != ArcEnd::fold || pieces_[i].next[side] >= 0) continue;
      const BranchSpan span = pieces_[i].span;
      const double part = side == 0 ? kBeside : 1 - kBeside;
      const Joints fold = (side == 0 ? pieces_[i].nodes.front() : pieces_[i].nodes.back()).q;
      for (const int bit : {1, 2, 4}) {
        if (add_partner(span.branch ^ bit, span, part, fold)) break;
      }
    }
  }
}

bool SelfMotionArcs::add_partner(int branch, const BranchSpan& span, double part,
                                 const Joints& fold) {
  const double fold_at = part < 0.5 ? span.lower : span.upper;
  const double inside = span.value(part);
  for (const BranchSpan& known : spans_) {
    if (known.branch == branch && known.lower <= inside && inside <= known.upper) return false;
  }
  const double ahead = fold_at + (part < 0.5 ? places_.step : -places_.step);
  const auto value = [&](int lane) { return inside + (ahead - inside) * lane / (kLanes - 1); };
  branches_.solve_one(branch, value);
  constexpr double kMerged = 0.1;
  if (branches_.least(0) < 0 || joints_.distance(node(0, 0).q, fold) > kMerged) return false;
  int end = 1;
  while (end < kLanes && branches_.least(end) >= 0) ++end;
  if (end == kLanes) return false;
  const double other = branches_.last_existing(branch, value(end - 1), value(end), kEndRounds);
  add_span({branch, std::min(fold_at, other), std::max(fold_at, other), true, true});
  return true;
}

void SelfMotionArcs::chain(double spacing) {
  // Several times as many as arcs of this length need. Where the arm is singular all along a span,
  // its joints are rounding's, and no split brings them nearer to each other.
  constexpr double kLongest = 20 * kTwoPi;
  splits_left_ = static_cast<int>(std::min(kLongest / spacing, 1e9)) + 64;
  const auto count = static_cast<int>(pieces_.size());
  // First those that end somewhere, then what is left: rings.
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i < count; ++i) {
      if (pieces_[static_cast<std::size_t>(i)].next[side] < 0) follow(i, side, spacing);
    }
  }
  for (int i = 0; i < count; ++i) follow(i, 0, spacing);
}

void SelfMotionArcs::follow(int first, int side, double spacing) {
  if (pieces_[static_cast<std::size_t>(first)].is_used) return;
  Arc arc;
  arc.begin = pieces_[static_cast<std::size_t>(first)].ends[side];
  int at = first;
  while (true) {
    Piece& piece = pieces_[static_cast<std::size_t>(at)];
    piece.is_used = true;
    append(piece, side == 1, spacing, arc);
    const int exit = 1 - side;
    at = piece.next[exit];
    side = piece.next_side[exit];
    arc.end = piece.ends[exit];
    if (at < 0) break;
    if (pieces_[static_cast<std::size_t>(at)].is_used) {
      arc.begin = arc.end = SelfMotionEnd{};
      break;
    }
  }
  // The seam of a whole turn ends nothing, unless the curve was not found behind it.
  if (at < 0) {
    for (SelfMotionEnd* end : {&arc.begin, &arc.end}) {
      if (end->kind == ArcEnd::closed) end->kind = ArcEnd::fold;
    }
  }
  finish(arc, spacing);
  arcs_.push_back(std::move(arc));
}

void SelfMotionArcs::append(const Piece& piece, bool backwards, double spacing, Arc& arc) {
  const std::size_t count = piece.nodes.size();
  const auto node = [&](std::size_t i) -> const Node& {
    return piece.nodes[backwards ? count - 1 - i : i];
  };
  // Where branches merge it is there already.
  if (arc.q.empty()) arc.q.push_back(node(0).q);
  for (std::size_t i = 1; i < count; ++i) {
    append_between(piece.span, node(i - 1), node(i), spacing, 0, arc);
    arc.q.push_back(node(i).q);
  }
}

void SelfMotionArcs::append_between(const BranchSpan& span, const Node& a, const Node& b,
                                    double spacing, int depth, Arc& arc) {
  constexpr int kDeepest = 6;
  if (depth == kDeepest || splits_left_ <= 0 || joints_.distance(a.q, b.q) <= spacing) return;
  --splits_left_;
  const std::array<Node, kLanes> between = nodes_between(span, a, b);
  const Node* before = &a;
  for (const Node& next : between) {
    append_between(span, *before, next, spacing, depth + 1, arc);
    arc.q.push_back(next.q);
    before = &next;
  }
  append_between(span, *before, b, spacing, depth + 1, arc);
}

void SelfMotionArcs::finish(Arc& arc, double spacing) const {
  const bool closed = arc.begin.kind == ArcEnd::closed;
  if (closed && arc.q.size() > 1) arc.q.pop_back();
  // Points nearer to each other than asked are left out.
  std::size_t kept = 0;
  for (std::size_t i = 1; i < arc.q.size(); ++i) {
    const bool is_last = i + 1 == arc.q.size();
    if (!is_last && joints_.distance(arc.q[kept], arc.q[i + 1]) <= spacing) continue;
    arc.q[++kept] = arc.q[i];
  }
  arc.q.resize(kept + 1);
  for (std::size_t i = 1; i < arc.q.size(); ++i)
    arc.length += joints_.distance(arc.q[i - 1], arc.q[i]);
  if (closed) arc.length += joints_.distance(arc.q.back(), arc.q.front());
}

std::vector<SelfMotionArcs::Joints> SelfMotionArcs::spread(int count, double least) const {
  double length = 0;
  for (const Arc& arc : arcs_) length += arc.length;
  const double spacing = std::max(length / count, 1.01 * least);
  std::vector<Joints> places;
  for (const Arc& arc : arcs_) {
    places.push_back(arc.q.front());
    const double steps = std::floor(arc.length / spacing);
    if (steps < 1) continue;
    const bool closed = arc.begin.kind == ArcEnd::closed;
    const double step = arc.length / steps;
    double left = step;
    for (std::size_t i = 1; i < arc.q.size() + (closed ? 1 : 0); ++i) {
      const Joints& a = arc.q[i - 1];
      const Joints& b = arc.q[i % arc.q.size()];
      const double way = joints_.distance(a, b);
      double at = left;
      for (; at <= way; at += step) {
        Joints q = a;
        for (int j = 0; j < SweptBranches::kDof; ++j) {
          const auto k = static_cast<std::size_t>(j);
          q[k] += at / way * joints_.difference(j, a[k], b[k]);
        }
        places.push_back(q);
      }
      left = at - way;
    }
    // Rounding may have left out the end.
    if (!closed && left < 0.5 * step) places.push_back(arc.q.back());
  }
  return places;
}

}  // namespace iksel
