// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/free_samples.hpp"

#include <iterator>
#include <memory>
#include <utility>

namespace iksel {
namespace {

/// The samples of the sweep come in so many parts.
constexpr int kSampleParts = 16;
/// Peaks that are looked beside, at most: those that overlap least.
constexpr std::size_t kMostPeaks = 24;

}  // namespace

FreeSamples::FreeSamples(Sweep& sweep, const Scene& scene, const Pose& Y, Memory& memory,
                         Work& work, std::size_t most)
    : RowSeeds(work, &Work::take_on_top), sweep_(sweep), scene_(scene), to_(memory), most_(most) {
  look_.is_target_clear = true;
  to_.q.clear();
  to_.samples.clear();
  to_.overlaps.clear();
  to_.places.clear();
  to_.clearance.assign(Sweep::kSamples * lanes::kWidth, kInfinity);
  sweep_.set_target(Y);
}

bool FreeSamples::next_stage() {
  std::size_t count = 0;
  while (count == 0 && !has_most() && (at_ < rows() || add_rows())) count = screen_pack();
  given_ += count;
  give(free_.data(), count, kCurveJoints, /*are_answers=*/true);
  work_.lap(&StageTimes::query);
  return count > 0;
}

bool FreeSamples::add_rows() {
  to_.q.clear();
  to_.samples.clear();
  at_ = 0;
  while (to_.q.empty()) {
    if (part_ < kSampleParts) {
      // 7 and 16 have no factor in common: each part once.
      sweep_.add_samples(part_ * 7 % kSampleParts, kSampleParts, to_.q, to_.samples);
      ++part_;
    } else if (!add_rows_between()) {
      return false;
    }
  }
  has_any_ = true;
  return true;
}

bool FreeSamples::add_rows_between() {
  if (beside_) {
    // Once more, more closely.
    const Place least = *beside_;
    beside_.reset();
    sweep_.add_beside(least.q.data(), least.sample.branch, Sweep::kSpacingBeside, to_.q);
    return true;
  }
  const Place* place = next_place();
  if (place == nullptr) return false;
  if (place->kind == Place::Kind::lower_end || place->kind == Place::Kind::upper_end) {
    sweep_.add_end(place->sample, place->kind == Place::Kind::upper_end, to_.q);
    return true;
  }
  if (place->kind == Place::Kind::overlap) {
    beside_ = *place;
  } else {
    to_.q.assign(place->q.begin(), place->q.end());
  }
  sweep_.add_beside(place->q.data(), place->sample.branch, 1.0, to_.q);
  return true;
}

const FreeSamples::Place* FreeSamples::next_place() {
  if (!has_peaks_) {
    has_peaks_ = true;
    find_peaks_and_ends();
  }
  if (place_ == to_.places.size() && !has_between_) {
    has_between_ = true;
    sweep_.visit_between([&](const double* q, int branch) {
      Place& between = to_.places.emplace_back();
      between.kind = Place::Kind::between;
      between.sample.branch = branch;
      std::copy_n(q, kCurveJoints, between.q.begin());
    });
  }
  return place_ < to_.places.size() ? &to_.places[place_++] : nullptr;
}

bool FreeSamples::is_peak(const Place& overlap) const {
  /// So many times as fast as from one sample to the next what overlaps may part between them.
  constexpr double kFaster = 3;
  const auto [place, branch] = overlap.sample;
  double slope = 0;
  for (const int beside : {place - 1, place + 1}) {
    const int at = sweep_.places().find(beside);
    if (at < 0 || !exists(at, branch)) {
      slope = kInfinity;
    } else if (clearance(at, branch) > overlap.clearance) {
      return false;
    } else {
      slope = std::max(slope, overlap.clearance - clearance(at, branch));
    }
  }
  return overlap.clearance + kFaster * slope >= 0;
}

void FreeSamples::find_peaks_and_ends() {
  auto& places = to_.places;
  std::copy_if(to_.overlaps.begin(), to_.overlaps.end(), std::back_inserter(places),
               [&](const Place& each) { return is_peak(each); });
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.clearance > b.clearance || (a.clearance == b.clearance && a.number < b.number);
  });
  places.resize(std::min(kMostPeaks, places.size()));
  for (const Place& each : to_.overlaps) {
    const auto [place, branch] = each.sample;
    for (const bool up : {false, true}) {
      const int at = sweep_.places().find(up ? place + 1 : place - 1);
      if (at < 0 || exists(at, branch)) continue;
      places.push_back({up ? Place::Kind::upper_end : Place::Kind::lower_end, each.sample, {}});
    }
  }
}

std::size_t FreeSamples::screen_pack() {
  std::size_t free = 0;
  const std::size_t count = std::min<std::size_t>(lanes::kWidth, rows() - at_);
  for (std::size_t i = at_; i < at_ + count; ++i) {
    const double above = scene_.data().find_clearance(row(i), look_);
    if (above > 0) {
      std::copy_n(row(i), kCurveJoints, &free_[kCurveJoints * free++]);
    } else if (i < to_.samples.size()) {
      Place& overlap = to_.overlaps.emplace_back();
      overlap.kind = Place::Kind::overlap;
      overlap.clearance = above;
      overlap.sample = to_.samples[i];
      overlap.number = static_cast<int>(to_.overlaps.size());
      clearance(overlap.sample.place, overlap.sample.branch) = above;
      std::copy_n(row(i), kCurveJoints, overlap.q.begin());
    } else if (beside_ && above > beside_->clearance) {
      beside_->clearance = above;
      std::copy_n(row(i), kCurveJoints, beside_->q.begin());
    }
  }
  at_ += count;
  return free;
}

bool find_nearest_passing(const std::vector<Curve::Arc>& arcs, const Passes& passes,
                          const JointSpace& joints, const JointVector& near, const JointMove& move,
                          std::size_t most, std::vector<double>& q) {
  // Nearest first, so that few are looked at.
  std::vector<std::pair<double, JointVector>> points;
  for (const Curve::Arc& arc : arcs) {
    for (const Curve::Joints& on_arc : arc.q) {
      JointVector point = Eigen::Map<const Eigen::VectorXd>(on_arc.data(), kCurveJoints);
      joints.wrap_nearest(near, 0, point);
      points.emplace_back(move.length(point - near), std::move(point));
    }
  }
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  q.clear();
  for (const auto& point : points) q.insert(q.end(), point.second.begin(), point.second.end());
  std::size_t kept = 0;
  std::unique_ptr<bool[]> keep(new bool[points.size() + 1]);
  // Twice as many from time to time, as a filter takes its time for each call.
  std::size_t count = lanes::kWidth;
  for (std::size_t i = 0; i < points.size() && kept < most; i += count, count *= 2) {
    count = std::min(count, points.size() - i);
    passes(&q[i * kCurveJoints], count, keep.get());
    for (std::size_t k = 0; k < count && kept < most; ++k) {
      if (keep[k]) std::copy_n(&q[(i + k) * kCurveJoints], kCurveJoints, &q[kCurveJoints * kept++]);
    }
  }
  q.resize(kept * kCurveJoints);
  return !points.empty();
}

}  // namespace iksel
