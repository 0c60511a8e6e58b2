// SPDX-License-Identifier: BSD-3-Clause
// Along the arcs of a self-motion.
#include <algorithm>
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
  for (Sample& sample : samples_) {
    if (!sample.is_known) follow_both_ways(sample.q);
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
  for (std::size_t j = 0; j < kDof; ++j) at.q[j] = pack_.q[j][0];
  std::vector<Walk> walks{walk_from(at, false)};
  const std::size_t forwards = follow(walks);
  if (forwards == kNone || arcs_[forwards].is_closed()) return;
  walks[0] = walk_from(at, true);
  const std::size_t backwards = follow(walks);
  if (backwards == kNone) return;
  Arc& whole = arcs_[backwards];
  const Arc& rest = arcs_[forwards];
  whole.q.insert(whole.q.end(), rest.q.begin() + 1, rest.q.end());
  whole.end = rest.end;
  std::swap(arcs_[forwards], whole);
  arcs_.pop_back();
}

std::size_t Curve::follow(std::vector<Walk>& walks) {
  /// A walk that comes to so short steps is at a singularity [rad and m].
  constexpr double kShortest = 1e-6;
  std::array<std::size_t, kLanes> walk_of{};
  std::size_t next = 0;
  std::size_t arc = kNone;
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
        if (advance(walk, lane, arc)) continue;
      } else {
        if (pack_.step[lane] >= kShortest) continue;
        arc = finish(walk, {ArcEnd::fold});
      }
      load(lane);
    }
  }
  return arc;
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

bool Curve::advance(Walk& walk, int lane, std::size_t& arc) {
  constexpr double kLongestArc = 20 * kTwoPi;
  Joints next;
  Joints tangent;
  for (std::size_t j = 0; j < kDof; ++j) {
    next[j] = pack_.q[j][lane];
    tangent[j] = pack_.tangent[j][lane];
  }
  const Joints& last = walk.q.back();
  const double way = way_between(last, next);
  const Exit out = exit(walk, next, tangent, way);
  if (out.part <= 1) {
    if (turn_round(walk, lane, next)) {
      walk.tangent = tangent;
      return true;
    }
    Joints q;
    for (std::size_t j = 0; j < kDof; ++j) {
      q[j] = Cubic{last[j], way * walk.tangent[j], next[j], way * tangent[j]}(out.part);
    }
    mark_samples(last, q);
    arc = leave(walk, q, out.at);
    return false;
  }
  mark_samples(last, next);
  if (is_closed(walk, next)) {
    walk.begin = {};
    arc = finish(walk, {});
    return false;
  }
  walk.q.push_back(next);
  walk.tangent = tangent;
  if (static_cast<double>(walk.q.size()) < 1000 + kLongestArc / pack_.longest) return true;
  arc = finish(walk, {ArcEnd::fold});
  return false;
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

Curve::Joints Curve::corrected(const Joints& q) {
  constexpr int kRounds = 2;
  lanes::CurvePack& probe = probe_;
  for (int row = 0; row < lanes::kFullPoseRows; ++row) probe.target[row] = pack_.target[row];
  for (std::size_t j = 0; j < kDof; ++j) std::fill_n(probe.q[j], kLanes, q[j]);
  for (int round = 0; round < kRounds; ++round) kernels_.orient_curves(chain_, probe);
  Joints on_curve;
  for (std::size_t j = 0; j < kDof; ++j) on_curve[j] = probe.q[j][0];
  return on_curve;
}

Curve::Exit Curve::exit(const Walk& walk, const Joints& next, const Joints& tangent, double way) {
  constexpr int kHalvings = 40;
  /// What a cubic may be off by, and a configuration that was corrected once [rad or m].
  constexpr double kDoubtful = 2e-3;
  const Joints& last = walk.q.back();
  Exit first{2, {}};
  for (const Limit& limit : limits_) {
    const Cubic value{limit.value(last), way * limit.value(walk.tangent), limit.value(next),
                      way * limit.value(tangent)};
    // Far from it, nothing is to be looked for between.
    const double room = std::min({value.from - limit.lower, limit.upper - value.from,
                                  value.to - limit.lower, limit.upper - value.to});
    if (room > 0.5 * (std::abs(value.slope_from) + std::abs(value.slope_to))) continue;
    std::array<double, 2> turns{};
    const int count = value.turns(turns);
    for (int i = 0; i <= count; ++i) {
      double outside = i < count ? turns[static_cast<std::size_t>(i)] : 1;
      const double at = value(outside);
      if (at >= limit.lower - kAtLimit && at <= limit.upper + kAtLimit) continue;
      const bool at_upper = at > limit.upper;
      if (std::max(limit.lower - at, at - limit.upper) < kDoubtful) {
        Joints q;
        for (std::size_t j = 0; j < kDof; ++j) {
          q[j] = Cubic{last[j], way * walk.tangent[j], next[j], way * tangent[j]}(outside);
        }
        const double there = limit.value(corrected(q));
        if (there >= limit.lower - kAtLimit && there <= limit.upper + kAtLimit) continue;
      }
      double inside = i > 0 ? turns[static_cast<std::size_t>(i - 1)] : 0;
      for (int halving = 0; halving < kHalvings; ++halving) {
        const double middle = 0.5 * (inside + outside);
        const bool is_out = at_upper ? value(middle) > limit.upper : value(middle) < limit.lower;
        (is_out ? outside : inside) = middle;
      }
      if (inside < first.part) {
        first.part = inside;
        first.at = limit.at;
        first.at.at_upper = at_upper;
      }
      break;
    }
  }
  return first;
}

std::size_t Curve::leave(Walk& walk, const Joints& q, const SelfMotionEnd& at) {
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
    return finish(walk, at);
  }
  // Of two that come to one end, one has gone over where the curve is outside of a limit.
  if (end->is_taken) return kNone;
  walk.q.push_back(end->q);
  end->is_taken = true;
  return end->arc = finish(walk, at);
}

bool Curve::is_closed(const Walk& walk, const Joints& next) const {
  if (walk.begin.kind == ArcEnd::limit || walk.q.size() < 3) return false;
  constexpr double kBeside2 = 0.04;
  double along = 0;
  double way2 = 0;
  double rest2 = 0;
  for (int j = 0; j < kDof; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double step = next[i] - walk.q.back()[i];
    const double to_start = joints_.difference(j, walk.q.back()[i], walk.q.front()[i]);
    along += step * to_start;
    way2 += step * step;
    rest2 += to_start * to_start;
  }
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
    Sample* found = nullptr;
    double nearest = kSame;
    const auto at = static_cast<std::size_t>(place);
    for (std::size_t k = first_sample_[at]; k < first_sample_[at + 1]; ++k) {
      if (samples_[k].is_known) continue;
      const double away = joints_.distance(samples_[k].q, q, nearest);
      if (away >= nearest) continue;
      nearest = away;
      found = &samples_[k];
    }
    if (found != nullptr) found->is_known = true;
  }
}

std::size_t Curve::finish(Walk& walk, const SelfMotionEnd& end) {
  Arc& arc = arcs_.emplace_back();
  arc.q = std::move(walk.q);
  arc.begin = walk.begin;
  arc.end = end;
  if (walk.is_reversed) {
    std::reverse(arc.q.begin(), arc.q.end());
    std::swap(arc.begin, arc.end);
  }
  for (Joints& q : arc.q) joints_.wrap(q.data());
  return arcs_.size() - 1;
}

bool Curve::is_on_arc(const Joints& q) const {
  constexpr double kBeside2 = 1e-3;
  for (const Arc& arc : arcs_) {
    for (std::size_t i = 1; i < arc.q.size(); ++i) {
      double along = 0;
      double way2 = 0;
      double rest2 = 0;
      for (int j = 0; j < kDof; ++j) {
        const auto k = static_cast<std::size_t>(j);
        const double step = joints_.difference(j, arc.q[i - 1][k], arc.q[i][k]);
        const double off = joints_.difference(j, arc.q[i - 1][k], q[k]);
        along += step * off;
        way2 += step * step;
        rest2 += off * off;
      }
      const double part = std::min(std::max(along, 0.0), way2);
      if (rest2 - (2 * along - part) * part / std::max(way2, 1e-12) < kBeside2) return true;
    }
  }
  return false;
}

}  // namespace iksel
