// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/free_samples.hpp"

#include <cmath>
#include <utility>

namespace iksel {
namespace {

/// The samples of the sweep come in so many parts.
constexpr int kSampleParts = 16;
/// Samples that are looked beside, at most: those that overlap least.
constexpr std::size_t kMostBeside = 24;

/// A number for what a configuration collided with.
std::uint32_t number_of(const lanes::SceneCulprit& culprit) {
  const auto kind = static_cast<std::uint32_t>(culprit.kind);
  const auto index = static_cast<std::uint32_t>(culprit.index);
  const auto link = static_cast<std::uint32_t>(culprit.link);
  return (link * 100'003 + index) * 8 + kind;
}

}  // namespace

FreeSamples::FreeSamples(Sweep& sweep, const Scene& scene, const Pose& Y, Memory& memory,
                         Work& work, StageClock& clock)
    : sweep_(sweep), scene_(scene), Y_(Y), to_(memory), work_(work), clock_(clock) {
  look_.is_target_clear = true;
  to_.q.clear();
  to_.samples.clear();
  to_.overlaps.clear();
  to_.known.assign(Sweep::kSamples * kPack, Known());
  sweep_.set_target(Y);
}

bool FreeSamples::next_stage() {
  free_count_ = 0;
  next_ = 0;
  while (free_count_ == 0 && (at_ < rows() || add_rows())) screen_pack();
  clock_.lap(&StageTimes::query);
  return free_count_ > 0;
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
    } else if (const Overlap* next = next_overlap()) {
      sweep_.add_beside(next->q.data(), next->sample.branch, to_.q);
    } else if (has_any_ || !add_between()) {
      return false;
    }
  }
  has_any_ = true;
  return true;
}

bool FreeSamples::add_between() {
  if (!sweep_.find(Y_)) return false;
  std::array<double, kDof> q{};
  std::copy_n(sweep_.q(), kDof, q.begin());
  to_.q.assign(q.begin(), q.end());
  sweep_.add_beside(q.data(), sweep_.branch(), to_.q);
  return true;
}

bool FreeSamples::may_be_free_beside(const Overlap& overlap) const {
  const int branch = overlap.sample.branch;
  const int below = sweep_.places().find(overlap.sample.place - 1);
  const int above = sweep_.places().find(overlap.sample.place + 1);
  if (below < 0 || above < 0) return true;
  const Known& here = known(overlap.sample.place, branch);
  const Known& before = known(below, branch);
  const Known& behind = known(above, branch);
  const auto by = here.culprit;
  if (by == 0 || before.culprit != by || behind.culprit != by) return true;
  // The three collide by the same: it would have to part twice as fast between them as from one to
  // the next.
  const float slope = std::max(std::abs(here.clearance - before.clearance),
                               std::abs(behind.clearance - here.clearance));
  return std::max({before.clearance, here.clearance, behind.clearance}) + slope >= 0;
}

const FreeSamples::Overlap* FreeSamples::next_overlap() {
  if (beside_ == 0) {
    auto& all = to_.overlaps;
    all.erase(std::remove_if(all.begin(), all.end(),
                             [&](const Overlap& each) { return !may_be_free_beside(each); }),
              all.end());
  }
  const std::size_t most = std::min(kMostBeside, to_.overlaps.size());
  if (beside_ == most) return nullptr;
  if (beside_ == 0) {
    std::partial_sort(to_.overlaps.begin(),
                      to_.overlaps.begin() + static_cast<std::ptrdiff_t>(most), to_.overlaps.end(),
                      [](const Overlap& a, const Overlap& b) { return a.clearance > b.clearance; });
  }
  return &to_.overlaps[beside_++];
}

void FreeSamples::screen_pack() {
  const std::size_t count = std::min(kPack, rows() - at_);
  for (std::size_t i = at_; i < at_ + count; ++i) {
    const double above = scene_.data().find_clearance(row(i), look_);
    if (above > 0) {
      free_[free_count_++] = i;
    } else if (i < to_.samples.size()) {
      Overlap& overlap = to_.overlaps.emplace_back();
      overlap.clearance = above;
      overlap.sample = to_.samples[i];
      Known& of_sample = known(overlap.sample.place, overlap.sample.branch);
      of_sample.clearance = static_cast<float>(above);
      // Points are no culprit.
      of_sample.culprit = above < 0 ? number_of(look_.culprit) : 0;
      std::copy_n(row(i), kDof, overlap.q.begin());
    }
  }
  at_ += count;
}

bool find_nearest_free(const SelfMotionArcs& arcs, const Scene& scene, const JointSpace& joints,
                       const JointVector& near, const JointMove& move, std::size_t most,
                       std::vector<double>& q) {
  constexpr std::size_t kPack = SweptBranches::kCount;
  constexpr std::size_t kDof = SweptBranches::kDof;
  // Nearest first, so that the scene looks at few.
  std::vector<std::pair<double, JointVector>> points;
  for (const SelfMotionArcs::Arc& arc : arcs.arcs()) {
    for (const SelfMotionArcs::Joints& on_arc : arc.q) {
      JointVector point = Eigen::Map<const Eigen::VectorXd>(on_arc.data(), kDof);
      joints.wrap_nearest(near, 0, point);
      points.emplace_back(move.length(point - near), std::move(point));
    }
  }
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  q.clear();
  for (std::size_t i = 0; i < points.size() && q.size() < most * kDof; i += kPack) {
    const std::size_t count = std::min(kPack, points.size() - i);
    std::array<double, kPack * kDof> rows{};
    for (std::size_t k = 0; k < count; ++k) {
      std::copy_n(points[i + k].second.data(), kDof, &rows[k * kDof]);
    }
    std::array<bool, kPack> free{};
    scene.find_free(rows.data(), count, free.data());
    for (std::size_t k = 0; k < count; ++k) {
      if (!free[k]) continue;
      const double* row = &rows[k * kDof];
      q.insert(q.end(), row, row + kDof);
    }
  }
  return !points.empty();
}

}  // namespace iksel
