// SPDX-License-Identifier: BSD-3-Clause
// Along the arcs of a self-motion.
#include <algorithm>
#include <cmath>

#include "seeds/curve.hpp"

namespace iksel {

void Curve::follow_from_ends() {
  std::vector<Walk> walks;
  for (const bool is_reversed : {false, true}) {
    // Backwards what leads to an end that was not known, or through a singularity.
    walks.clear();
    for (End& end : ends_) {
      if (end.is_taken || end.touches() || end.leads_in == is_reversed) continue;
      end.is_taken = true;
      walks.push_back({{end.q}, end.on_curve.tangent, end.at, is_reversed, {}});
    }
    follow(walks);
  }
  // Mostly it is on an arc by now, which goes over it.
  for (const End& end : ends_) {
    if (end.touches()) follow_both_ways(end.q.data());
  }
}

void Curve::follow_from_samples(Sweep& sweep) {
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (!is_known_[i]) follow_both_ways(&sampled_q_[i * kCurveJoints]);
  }
  sweep.visit_between([&](const double* q, int /*branch*/) { follow_both_ways(q); });
}

void Curve::follow_both_ways(const double* from) {
  Place at{};
  std::copy_n(from, kCurveJoints, at.q.begin());
  if (is_on_arc(at.q)) return;
  walker_.orient(&at, 1);
  std::vector<Walk> forwards{{{at.q}, at.tangent, {ArcEnd::fold}, false, {}}};
  follow(forwards);
  const auto ahead = forwards[0].arc;
  if (!ahead || arcs_[*ahead].is_closed()) return;
  std::vector<Walk> backwards{{{at.q}, at.tangent, {ArcEnd::fold}, true, {}}};
  follow(backwards);
  if (!backwards[0].arc) return;
  Arc& whole = arcs_[*backwards[0].arc];
  const Arc& rest = arcs_[*ahead];
  whole.q.insert(whole.q.end(), rest.q.begin() + 1, rest.q.end());
  whole.end = rest.end;
  std::swap(arcs_[*ahead], whole);
  arcs_.pop_back();
}

void Curve::follow(std::vector<Walk>& walks) {
  std::size_t next = 0;
  std::array<Walk*, lanes::kWidth> in_lane{};
  const auto walk = [&](int lane) -> Walk*& { return in_lane[static_cast<std::size_t>(lane)]; };
  walker_.follow(
      [&](int lane, Place& from, bool& is_reversed) {
        if (next == walks.size()) return false;
        walk(lane) = &walks[next++];
        from = {walk(lane)->q.front(), walk(lane)->tangent};
        is_reversed = walk(lane)->is_reversed;
        return true;
      },
      [&](int lane, const Step& step) { return advance(*walk(lane), lane, step); },
      [&](int lane) { finish(*walk(lane), {ArcEnd::fold}); });
}

void Curve::add_between(Walk& walk, const Step& step, double end) const {
  const double count = std::ceil(end * step.way / spacing_);
  for (double i = 1; i < count; ++i) walk.q.push_back(step.at(i / count * end));
}

bool Curve::advance(Walk& walk, int lane, const Step& step) {
  constexpr double kLongestArc = 20 * kTwoPi;
  const Joints& last = step.from.q;
  const Joints& next = step.to.q;
  const CurveWalker::Exit exit = walker_.exit(step);
  if (exit.part <= 1) {
    // It goes on at another image, if that lies inside the limits.
    Joints image = next;
    if (joints_.wrap_sums(image.data()) && walker_.is_inside(image)) {
      walker_.turn_to(lane, image);
      walk.q.push_back(image);
      return true;
    }
    const Joints q = step.at(exit.part);
    mark_samples(last, q);
    add_between(walk, step, exit.part);
    leave(walk, q, exit.at);
    return false;
  }
  mark_samples(last, next);
  if (const double part = closes_at(walk, next); part > 0) {
    add_between(walk, step, part);
    walk.begin = {};
    finish(walk, {});
    return false;
  }
  add_between(walk, step, 1);
  walk.q.push_back(next);
  const double spacing = std::min(walker_.longest(), spacing_);
  if (static_cast<double>(walk.q.size()) < 1000 + kLongestArc / spacing) return true;
  finish(walk, {ArcEnd::fold});
  return false;
}

Curve::Beside Curve::beside(const Joints& from, const Joints& to, const Joints& q) const {
  Beside found{};
  for (int j = 0; j < kCurveJoints; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double step = joints_.difference(j, from[i], to[i]);
    const double off = joints_.difference(j, from[i], q[i]);
    found.along += step * off;
    found.way2 += step * step;
    found.rest2 += off * off;
  }
  return found;
}

double Curve::closes_at(const Walk& walk, const Joints& next) const {
  if (walk.begin.kind == ArcEnd::limit || walk.q.size() < 3) return 0;
  constexpr double kBeside2 = 0.04;
  const auto [along, way2, rest2] = beside(walk.q.back(), next, walk.q.front());
  const bool closes = along > 0 && along <= way2 && rest2 - along * along / way2 < kBeside2 * way2;
  return closes ? along / way2 : 0;
}

void Curve::mark_samples(const Joints& from, const Joints& to) {
  constexpr double kSame = 0.1;
  if (samples_.empty()) return;
  const auto swept = static_cast<std::size_t>(swept_);
  const double begin = (from[swept] - places_->lower) / places_->step;
  const double end = (to[swept] - places_->lower) / places_->step;
  const int last = static_cast<int>(std::floor(std::max(begin, end)));
  for (int i = static_cast<int>(std::ceil(std::min(begin, end))); i <= last; ++i) {
    const int place = places_->find(i);
    if (place < 0) continue;
    const double part = begin == end ? 0 : (i - begin) / (end - begin);
    Joints q;
    for (std::size_t j = 0; j < kCurveJoints; ++j) q[j] = from[j] + part * (to[j] - from[j]);
    std::size_t found = samples_.size();
    double nearest = kSame;
    const auto at = static_cast<std::size_t>(place);
    for (std::size_t k = first_sample_[at]; k < first_sample_[at + 1]; ++k) {
      if (is_known_[k]) continue;
      const double away = joints_.distance(&sampled_q_[k * kCurveJoints], q, nearest);
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
  /// What is farther from where a step begins is not beside it [rad and m].
  const double far = 1.2 * std::min(walker_.longest(), spacing_) + 0.1;
  for (const Arc& arc : arcs_) {
    for (std::size_t i = 1; i < arc.q.size() + (arc.is_closed() ? 1 : 0); ++i) {
      if (!joints_.are_near(arc.q[i - 1], q, far)) continue;
      const auto [along, way2, rest2] = beside(arc.q[i - 1], arc.q[i % arc.q.size()], q);
      const double part = std::min(std::max(along, 0.0), way2);
      if (rest2 - (2 * along - part) * part / std::max(way2, 1e-12) < kBeside2) return true;
    }
  }
  return false;
}

void Curve::leave(Walk& walk, const Joints& q, const SelfMotionEnd& at) {
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
  // Of two that come to one end, one has gone over where the curve is outside of a limit.
  if (end != nullptr && end->is_taken) return;
  walk.q.push_back(end != nullptr ? end->q : q);
  if (end != nullptr) end->is_taken = true;
  finish(walk, at);
}

}  // namespace iksel
