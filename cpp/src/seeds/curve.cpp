// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/curve.hpp"

#include <algorithm>
#include <cmath>

namespace iksel {
namespace {

/// Curves are straight enough for longer steps, but limits between would be passed over [rad].
constexpr double kLongest = 0.25;

}  // namespace

const std::vector<Curve::Arc>& Curve::find(const Pose& T_base_tcp, const Pose& Y, ArcEnds* ends,
                                           Sweep* sweep, const double* known, std::size_t count,
                                           double spacing) {
  arcs_.clear();
  ends_.clear();
  samples_.clear();
  spacing_ = sweep != nullptr ? kInfinity : spacing;
  // What the way back to the curve adds to a step is a twentieth of it at most.
  walker_.set_target(Y, sweep != nullptr ? std::min(0.95 * spacing, kLongest) : kLongest);
  if (sweep != nullptr) find_samples(Y, *sweep);
  if (ends != nullptr) find_ends(T_base_tcp, *ends);
  follow_from_ends();
  if (sweep != nullptr) follow_from_samples(*sweep);
  for (std::size_t i = 0; i < count; ++i) follow_both_ways(known + i * kCurveJoints);
  for (Arc& arc : arcs_) thin_out(arc, spacing);
  return arcs_;
}

void Curve::find_samples(const Pose& Y, Sweep& sweep) {
  swept_ = sweep.joint();
  places_ = &sweep.places();
  sampled_q_.clear();
  sweep.set_target(Y);
  sweep.add_samples(0, 1, sampled_q_, samples_);
  is_known_.assign(samples_.size(), false);
  std::size_t place = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    while (place <= static_cast<std::size_t>(samples_[i].place)) first_sample_[place++] = i;
  }
  while (place < first_sample_.size()) first_sample_[place++] = samples_.size();
}

void Curve::find_ends(const Pose& T_base_tcp, ArcEnds& ends) {
  /// What is farther from the curve is none: it comes near to a limit, or all but touches it, and
  /// whether it does is seen on the way [rad or m].
  constexpr double kExact = 1e-5;
  /// Where a curve all but touches a limit, it is followed both ways.
  constexpr double kTouches = 1e-4;
  places_of_ends_.clear();
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const SelfMotionEnd at = ends.limit(i);
    if (joints_.is_periodic(at.joint)) continue;
    ends.begin();
    ends.find(i, T_base_tcp);
    for (int k = 0; k < ends.count(); ++k) {
      End end{};
      std::copy_n(ends.q(k), kCurveJoints, end.q.begin());
      end.at = at;
      if (!walker_.is_inside(end.q)) continue;
      ends_.push_back(end);
      places_of_ends_.push_back({end.q, {}});
    }
  }
  walker_.orient(places_of_ends_.data(), ends_.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    End& end = ends_[kept];
    end = ends_[i];
    end.on_curve = places_of_ends_[i];
    double moved = 0;
    for (std::size_t j = 0; j < kCurveJoints; ++j) {
      moved = std::max(moved, std::abs(end.on_curve.q[j] - end.q[j]));
    }
    // Written so that NaN is no end.
    if (!(moved <= kExact)) continue;
    const double up = end.on_curve.tangent[static_cast<std::size_t>(end.at.joint)];
    const double inside = end.at.at_upper ? -up : up;
    end.leads_in = !(inside < -kTouches);
    end.leads_out = !(inside > kTouches);
    ++kept;
  }
  ends_.resize(kept);
}

void Curve::spread(std::size_t count, double least, std::vector<double>& q) const {
  q.clear();
  const auto add = [&](const Joints& place) { q.insert(q.end(), place.begin(), place.end()); };
  double length = 0;
  for (const Arc& arc : arcs_) length += arc.length;
  const double spacing = std::max(length / static_cast<double>(count), least);
  for (const Arc& arc : arcs_) {
    add(arc.q.front());
    const double steps = std::floor(arc.length / spacing);
    if (steps < 1) continue;
    const double step = arc.length / steps;
    double left = step;
    for (std::size_t i = 1; i < arc.q.size() + (arc.is_closed() ? 1 : 0); ++i) {
      const Joints& a = arc.q[i - 1];
      const Joints& b = arc.q[i % arc.q.size()];
      const double way = joints_.distance(a, b);
      double at = left;
      for (; at <= way; at += step) {
        Joints between = a;
        for (int j = 0; j < kCurveJoints; ++j) {
          const auto k = static_cast<std::size_t>(j);
          between[k] += at / way * joints_.difference(j, a[k], b[k]);
        }
        add(between);
      }
      left = at - way;
    }
    // Rounding may have left out the end.
    if (!arc.is_closed() && left < 0.5 * step) add(arc.q.back());
  }
}

void Curve::thin_out(Arc& arc, double spacing) const {
  std::size_t kept = 0;
  for (std::size_t i = 1; i < arc.q.size(); ++i) {
    const bool is_last = i + 1 == arc.q.size();
    if (!is_last && joints_.distance(arc.q[kept], arc.q[i + 1]) <= spacing) continue;
    arc.q[++kept] = arc.q[i];
  }
  arc.q.resize(kept + 1);
  for (std::size_t i = 1; i < arc.q.size(); ++i) {
    arc.length += joints_.distance(arc.q[i - 1], arc.q[i]);
  }
  if (arc.is_closed()) arc.length += joints_.distance(arc.q.back(), arc.q.front());
}

}  // namespace iksel
