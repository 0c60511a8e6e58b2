// SPDX-License-Identifier: BSD-3-Clause
// Along the arcs of a self-motion.
#include <algorithm>
#include <cmath>

#include "seeds/curve.hpp"

namespace iksel {
namespace {

double way_between(const Curve::Joints& a, const Curve::Joints& b) {
  double way2 = 0;
  for (std::size_t j = 0; j < a.size(); ++j) way2 += (b[j] - a[j]) * (b[j] - a[j]);
  return std::sqrt(way2);
}

}  // namespace

Curve::Walk Curve::walk_from(const End& end, bool is_reversed) {
  Walk walk{{end.q}, end.tangent, end.at, is_reversed};
  if (is_reversed) {
    for (double& part : walk.tangent) part = -part;
  }
  return walk;
}

void Curve::follow_from_ends() {
  std::vector<Walk> walks;
  for (const bool is_reversed : {false, true}) {
    // Backwards what leads to an end that was not known, or through a singularity.
    walks.clear();
    for (End& end : ends_) {
      if (end.is_taken || !(is_reversed ? end.leads_out : end.leads_in)) continue;
      if (is_reversed || !end.leads_out) end.is_taken = true;
      walks.push_back(walk_from(end, is_reversed));
    }
    follow(walks);
  }
}

void Curve::follow_from_samples(Sweep& sweep) {
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (!is_known_[i]) follow_both_ways(sample(i));
  }
  sweep.visit_between([&](const double* q, int /*branch*/) {
    Joints between;
    std::copy_n(q, kDof, between.begin());
    follow_both_ways(between);
  });
}

void Curve::follow_both_ways(const Joints& from) {
  if (is_on_arc(from)) return;
  End at{};
  at.q = from;
  at.at.kind = ArcEnd::fold;
  orient(&at, 1);
  at.q = at.on_curve;
  std::vector<Walk> forwards{walk_from(at, false)};
  follow(forwards);
  const std::size_t ahead = forwards[0].arc;
  if (ahead == kNone || arcs_[ahead].is_closed()) return;
  std::vector<Walk> backwards{walk_from(at, true)};
  follow(backwards);
  const std::size_t behind = backwards[0].arc;
  if (behind == kNone) return;
  Arc& whole = arcs_[behind];
  const Arc& rest = arcs_[ahead];
  whole.q.insert(whole.q.end(), rest.q.begin() + 1, rest.q.end());
  whole.end = rest.end;
  std::swap(arcs_[ahead], whole);
  arcs_.pop_back();
}

void Curve::follow(std::vector<Walk>& walks) {
  /// A walk that comes to so short steps is at a singularity [rad and m].
  constexpr double kShortest = 1e-6;
  std::array<std::size_t, kLanes> walk_of{};
  std::size_t next = 0;
  unsigned busy = 0;
  const auto bit = [](int lane) { return 1U << static_cast<unsigned>(lane); };
  const auto load = [&](int lane) {
    busy &= ~bit(lane);
    if (next == walks.size()) return;
    walk_of[static_cast<std::size_t>(lane)] = next;
    start(walks[next++], lane);
    busy |= bit(lane);
  };
  for (int lane = 0; lane < kLanes; ++lane) load(lane);
  while (busy != 0) {
    const unsigned went = kernels_.follow_curves(chain_, pack_);
    for (int lane = 0; lane < kLanes; ++lane) {
      if ((busy & bit(lane)) == 0) continue;
      Walk& walk = walks[walk_of[static_cast<std::size_t>(lane)]];
      if ((went & bit(lane)) != 0) {
        if (advance(walk, lane)) continue;
      } else {
        if (pack_.step[lane] >= kShortest) continue;
        finish(walk, {ArcEnd::fold});
      }
      load(lane);
    }
  }
}

void Curve::start(const Walk& walk, int lane) {
  constexpr double kFirstStep = 0.05;
  for (std::size_t j = 0; j < kDof; ++j) {
    pack_.q[j][lane] = walk.q.front()[j];
    pack_.tangent[j][lane] = walk.tangent[j];
  }
  pack_.side[lane] = walk.is_reversed ? -1 : 1;
  pack_.step[lane] = std::min(kFirstStep, pack_.longest);
}

bool Curve::advance(Walk& walk, int lane) {
  constexpr double kLongestArc = 20 * kTwoPi;
  Joints next;
  Joints tangent;
  for (std::size_t j = 0; j < kDof; ++j) {
    next[j] = pack_.q[j][lane];
    tangent[j] = pack_.tangent[j][lane];
  }
  const Joints& last = walk.q.back();
  const Step step{last, walk.tangent, next, tangent, way_between(last, next)};
  const Exit out = exit(step);
  if (out.part <= 1) {
    if (turn_round(walk, lane, next)) {
      walk.tangent = tangent;
      return true;
    }
    const Joints q = step.at(out.part);
    mark_samples(last, q);
    leave(walk, q, out.at);
    return false;
  }
  mark_samples(last, next);
  if (is_closed(walk, next)) {
    walk.begin = {};
    finish(walk, {});
    return false;
  }
  walk.q.push_back(next);
  walk.tangent = tangent;
  if (static_cast<double>(walk.q.size()) < 1000 + kLongestArc / pack_.longest) return true;
  finish(walk, {ArcEnd::fold});
  return false;
}

Curve::Beside Curve::beside(const Joints& from, const Joints& to, const Joints& q) const {
  Beside found{};
  for (int j = 0; j < kDof; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double step = joints_.difference(j, from[i], to[i]);
    const double off = joints_.difference(j, from[i], q[i]);
    found.along += step * off;
    found.way2 += step * step;
    found.rest2 += off * off;
  }
  return found;
}

bool Curve::is_closed(const Walk& walk, const Joints& next) const {
  if (walk.begin.kind == ArcEnd::limit || walk.q.size() < 3) return false;
  constexpr double kBeside2 = 0.04;
  const auto [along, way2, rest2] = beside(walk.q.back(), next, walk.q.front());
  return along > 0 && along <= way2 && rest2 - along * along / way2 < kBeside2 * way2;
}

void Curve::mark_samples(const Joints& from, const Joints& to) {
  constexpr double kSame = 0.1;
  const auto swept = static_cast<std::size_t>(swept_);
  const double begin = (from[swept] - places_->lower) / places_->step;
  const double end = (to[swept] - places_->lower) / places_->step;
  const int last = static_cast<int>(std::floor(std::max(begin, end)));
  for (int i = static_cast<int>(std::ceil(std::min(begin, end))); i <= last; ++i) {
    const int place = places_->find(i);
    if (place < 0) continue;
    const double part = begin == end ? 0 : (i - begin) / (end - begin);
    Joints q;
    for (std::size_t j = 0; j < kDof; ++j) q[j] = from[j] + part * (to[j] - from[j]);
    std::size_t found = samples_.size();
    double nearest = kSame;
    const auto at = static_cast<std::size_t>(place);
    for (std::size_t k = first_sample_[at]; k < first_sample_[at + 1]; ++k) {
      if (is_known_[k]) continue;
      const double away = joints_.distance(&sampled_q_[k * kDof], q, nearest);
      if (away >= nearest) continue;
      nearest = away;
      found = k;
    }
    if (found < samples_.size()) is_known_[found] = true;
  }
}

void Curve::finish(Walk& walk, const SelfMotionEnd& end) {
  Arc& arc = arcs_.emplace_back();
  arc.q = std::move(walk.q);
  arc.begin = walk.begin;
  arc.end = end;
  if (walk.is_reversed) {
    std::reverse(arc.q.begin(), arc.q.end());
    std::swap(arc.begin, arc.end);
  }
  for (Joints& q : arc.q) joints_.wrap(q.data());
  walk.arc = arcs_.size() - 1;
}

bool Curve::is_on_arc(const Joints& q) const {
  constexpr double kBeside2 = 1e-3;
  for (const Arc& arc : arcs_) {
    for (std::size_t i = 1; i < arc.q.size(); ++i) {
      const auto [along, way2, rest2] = beside(arc.q[i - 1], arc.q[i], q);
      const double part = std::min(std::max(along, 0.0), way2);
      if (rest2 - (2 * along - part) * part / std::max(way2, 1e-12) < kBeside2) return true;
    }
  }
  return false;
}

}  // namespace iksel
