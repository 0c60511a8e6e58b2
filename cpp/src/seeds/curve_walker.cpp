// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/curve_walker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.hpp"
#include "simd/lane_chain.hpp"

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

double way_between(const CurveWalker::Joints& a, const CurveWalker::Joints& b) {
  double way2 = 0;
  for (std::size_t j = 0; j < a.size(); ++j) way2 += (b[j] - a[j]) * (b[j] - a[j]);
  return std::sqrt(way2);
}

/// Where a lane of a pack is.
CurveWalker::Place place(const lanes::CurvePack& pack, std::size_t lane) {
  CurveWalker::Place at;
  for (std::size_t j = 0; j < kCurveJoints; ++j) {
    at.q[j] = pack.q[j][lane];
    at.tangent[j] = pack.tangent[j][lane];
  }
  return at;
}

void put(const CurveWalker::Place& at, std::size_t lane, lanes::CurvePack& pack) {
  for (std::size_t j = 0; j < kCurveJoints; ++j) {
    pack.q[j][lane] = at.q[j];
    pack.tangent[j][lane] = at.tangent[j];
  }
}

}  // namespace

CurveWalker::CurveWalker(const ChainModel& model, const lanes::LaneKernels& kernels)
    : chain_(make_lane_chain(model)), kernels_(kernels) {
  model.joints.visit_limits([&](const Limit& limit) {
    if (limit.joint < 0 || !model.joints.winds(limit.joint)) limits_.push_back(limit);
  });
}

void CurveWalker::set_target(const Pose& Y, double longest) {
  pack_.longest = longest;
  visit_rows(Y, 1,
             [&](int row, double number) { pack_.target[row] = probe_.target[row] = number; });
}

bool CurveWalker::is_inside(const Joints& q) const {
  return std::all_of(limits_.begin(), limits_.end(), [&](const Limit& limit) {
    const double at = limit.value(q.data());
    return at >= limit.lower - kAtLimit && at <= limit.upper + kAtLimit;
  });
}

void CurveWalker::orient(Place* places, std::size_t count) {
  for (std::size_t first = 0; first < count; first += lanes::kWidth) {
    const std::size_t used = std::min<std::size_t>(lanes::kWidth, count - first);
    for (std::size_t lane = 0; lane < lanes::kWidth; ++lane) {
      put(places[first + std::min(lane, used - 1)], lane, probe_);
    }
    kernels_.orient_curves(chain_, probe_);
    for (std::size_t lane = 0; lane < used; ++lane) places[first + lane] = place(probe_, lane);
  }
}

void CurveWalker::follow(FunctionRef<bool(int lane, Place& from, bool& is_reversed)> begin,
                         FunctionRef<bool(int lane, const Step& step)> advance,
                         FunctionRef<void(int lane)> stop) {
  constexpr double kFirstStep = 0.05;
  // A walk that comes to steps so short is at a singularity.
  unsigned busy = 0;
  const auto bit = [](int lane) { return 1U << static_cast<unsigned>(lane); };
  const auto load = [&](int lane) {
    Place& at = at_[static_cast<std::size_t>(lane)];
    bool is_reversed = false;
    if (!begin(lane, at, is_reversed)) return false;
    pack_.side[lane] = is_reversed ? -1 : 1;
    for (double& part : at.tangent) part *= pack_.side[lane];
    put(at, static_cast<std::size_t>(lane), pack_);
    pack_.step[lane] = std::min(kFirstStep, pack_.longest);
    return true;
  };
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    if (load(lane)) busy |= bit(lane);
  }
  while (busy != 0) {
    const unsigned went = kernels_.follow_curves(chain_, pack_);
    for (int lane = 0; lane < lanes::kWidth; ++lane) {
      if ((busy & bit(lane)) == 0) continue;
      if ((went & bit(lane)) != 0) {
        Place& at = at_[static_cast<std::size_t>(lane)];
        const Place from = at;
        const Place to = place(pack_, static_cast<std::size_t>(lane));
        at = to;
        if (advance(lane, Step{from, to, way_between(from.q, to.q)})) continue;
      } else {
        if (pack_.step[lane] >= kSameAnswer) continue;
        stop(lane);
      }
      if (!load(lane)) busy &= ~bit(lane);
    }
  }
}

void CurveWalker::turn_to(int lane, const Joints& image) {
  Place& at = at_[static_cast<std::size_t>(lane)];
  at.q = image;
  put(at, static_cast<std::size_t>(lane), pack_);
}

CurveWalker::Joints CurveWalker::Step::at(double part) const {
  Joints q;
  for (std::size_t j = 0; j < kCurveJoints; ++j) {
    q[j] = Cubic{from.q[j], way * from.tangent[j], to.q[j], way * to.tangent[j]}(part);
  }
  return q;
}

CurveWalker::Exit CurveWalker::exit(const Step& step) const {
  Exit first{2, {}};
  for (const Limit& limit : limits_) look_at_limit(limit, step, first);
  return first;
}

void CurveWalker::look_at_limit(const Limit& limit, const Step& step, Exit& first) {
  const Cubic value{limit.value(step.from.q.data()),
                    step.way * limit.value(step.from.tangent.data()), limit.value(step.to.q.data()),
                    step.way * limit.value(step.to.tangent.data())};
  // Far from it, nothing is to be looked for between.
  const double room = std::min({value.from - limit.lower, limit.upper - value.from,
                                value.to - limit.lower, limit.upper - value.to});
  if (room > 0.5 * (std::abs(value.slope_from) + std::abs(value.slope_to))) return;
  std::array<double, 2> turns{};
  const int count = value.turns(turns);
  for (int i = 0; i <= count; ++i) {
    double outside = i < count ? turns[static_cast<std::size_t>(i)] : 1;
    const double at = value(outside);
    if (limit.beyond(at) <= kAtLimit) continue;
    const bool at_upper = at > limit.upper;
    double inside = i > 0 ? turns[static_cast<std::size_t>(i - 1)] : 0;
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (inside + outside);
      const bool is_out = at_upper ? value(middle) > limit.upper : value(middle) < limit.lower;
      (is_out ? outside : inside) = middle;
    }
    if (inside >= first.part) return;
    first = {inside, {ArcEnd::limit, limit.joint, at_upper, limit.coupled_limit}};
    return;
  }
}

}  // namespace iksel
