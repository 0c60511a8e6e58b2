// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/sweep.hpp"

#include <algorithm>
#include <cmath>

namespace iksel {
namespace {

/// The least of all branches.
double least_of(const SweptBranches::Row& row) {
  double least = row[0];
  for (const double value : row) least = std::min(least, value);
  return least;
}

}  // namespace

Sweep::Sweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
             double position_tolerance, double rotation_tolerance,
             const lanes::LaneKernels& kernels)
    : joints_(model.joints),
      branches_(model, chain, kernels),
      enclosure_(model, chain, position_tolerance, rotation_tolerance, kernels),
      places_(branches_.places(kSamples)),
      is_nominal_(is_nominal),
      rows_(kSamples) {
  // Memory is taken here, and none while solving: two branches of each open piece are looked at.
  looked_.reserve(2 * lanes::kWidth * enclosure_.open().capacity());
  found_.reserve(kFollowed * kCurveJoints);
  const double tolerance = std::max(position_tolerance / chain.unit, rotation_tolerance);
  if (!concludes_from_branches(is_nominal, tolerance)) return;
  close_ = std::max(0.01, 4 * std::sqrt(2 * tolerance));
}

bool Sweep::find_at_samples(const Pose& Y) {
  // Few, far from each other: what these do not find, the pieces do. With all of them random arms
  // wait up to a sixth longer where there is no answer, and the others no shorter in the mean.
  constexpr int kEvery = 4;
  set_target(Y);
  found_.clear();
  for (int first = 0; first < kSamples; first += kEvery * lanes::kWidth) {
    const auto value = [&](int i) { return places_.value(first + kEvery * i); };
    SweptBranches::Row rows[lanes::kWidth];
    branches_.rate(value, kNear, rows);
    for (int i = 0; i < lanes::kWidth; ++i) {
      if (take_answer(rows[i], value(i))) return true;
    }
  }
  return false;
}

bool Sweep::find_between(const Pose& Y) {
  set_target(Y);
  found_.clear();
  for (enclosure_.begin(Y);; enclosure_.halve()) {
    enclosure_.close();
    // Longer pieces have samples in them.
    if (enclosure_.is_through()) return look_in_pieces(lanes::kWidth) || follow_nearest();
    if (2 * enclosure_.half() < places_.step && look_in_pieces(1)) return true;
  }
}

bool Sweep::look_in_pieces(int places) {
  looked_.clear();
  apart_ = 2 * enclosure_.half() / places;
  for (const int last : {0, 1}) {
    for (const BranchEnclosure::Piece& piece : enclosure_.open()) {
      if (!piece.with[static_cast<std::size_t>(last)]) continue;
      const double first = branches_.from_form(piece.middle) - 0.5 * (places - 1) * apart_;
      for (int i = 0; i < places; ++i) {
        looked_.push_back({0, first + i * apart_, piece.arm + 4 * last});
      }
    }
  }
  std::size_t count = 0;
  for (std::size_t first = 0; first < looked_.size(); first += count) {
    const int branch = looked_[first].branch;
    const std::size_t most = std::min<std::size_t>(lanes::kWidth, looked_.size() - first);
    for (count = 1; count < most && looked_[first + count].branch == branch;) ++count;
    const auto value = [&](int lane) {
      return looked_[first + std::min(static_cast<std::size_t>(lane), count - 1)].at;
    };
    double off[lanes::kWidth];
    if (rate(branch, value, off)) return true;
    for (std::size_t lane = 0; lane < count; ++lane) looked_[first + lane].value = off[lane];
  }
  return false;
}

template <typename Value>
bool Sweep::rate(int branch, const Value& value, double (&off)[lanes::kWidth]) {
  // No angle is off by more.
  constexpr double kAnyAngle = 10;
  branches_.rate_one(branch, value, kNear, off);
  if (*std::min_element(off, off + lanes::kWidth) > 0) return false;
  branches_.solve_one(branch, value);
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    if (off[lane] > 0) continue;
    if (take(lane)) return true;
    off[lane] = branches_.off(lane) - kAnyAngle;
  }
  return false;
}

bool Sweep::follow_nearest() {
  Least<Place, kFollowed> nearest;
  const auto is_less = [&](std::size_t i, std::size_t j) {
    if (j >= looked_.size() || looked_[i].branch != looked_[j].branch) return true;
    if (std::abs(looked_[i].at - looked_[j].at) > 1.5 * apart_) return true;
    return i < j ? looked_[i].value <= looked_[j].value : looked_[i].value < looked_[j].value;
  };
  for (std::size_t i = 0; i < looked_.size(); ++i) {
    if (is_less(i, i - 1) && is_less(i, i + 1)) nearest.add(looked_[i]);
  }
  least_ = kInfinity;
  for (Place place : nearest) {
    if (follow(place, apart_)) return true;
    least_ = std::min(least_, place.value);
    branches_.solve_one(place.branch, [&](int /*lane*/) { return place.at; });
    branches_.copy_joints(0, q_.data());
    found_.insert(found_.end(), q_.begin(), q_.end());
  }
  return false;
}

Proof Sweep::proof_of_none() const {
  if (is_nominal_ && enclosure_.open().empty()) return Proof::intervals;
  // In pieces longer than what lies between samples it was not looked closely.
  const bool is_close = 2 * enclosure_.half() < places_.step;
  return is_close && least_ > close_ ? Proof::sweep : Proof::none;
}

void Sweep::visit_nearest(const Pose& Y, std::size_t most,
                          FunctionRef<void(const JointVector&)> visit) {
  set_target(Y);
  rate_samples();
  JointVector q(kCurveJoints);
  find_nearest(-kInfinity);
  for (const LeastPlace& near : nearest_) {
    if (most-- == 0) return;
    branches_.solve_all(places_.value(near.place));
    branches_.copy_joints(near.branch, q.data());
    visit(q);
  }
}

void Sweep::find_nearest(double beyond) {
  SweptBranches::Row none;
  none.fill(kInfinity);
  const auto row = [&](int place) -> const SweptBranches::Row& {
    const int at = places_.find(place);
    return at < 0 ? none : rows_[static_cast<std::size_t>(at)];
  };
  nearest_.clear();
  for (int place = 0; place < places_.count; ++place) {
    const SweptBranches::Row& here = row(place);
    if (least_of(here) > kNear) continue;
    const SweptBranches::Row& before = row(place - 1);
    const SweptBranches::Row& behind = row(place + 1);
    for (std::size_t i = 0; i < here.size(); ++i) {
      // Of conditions one by one few could be foreseen.
      const double least = std::min(kNear, std::min(before[i], behind[i]));
      if (here[i] <= least && here[i] > beyond) {
        nearest_.add({here[i], place, static_cast<int>(i)});
      }
    }
  }
}

void Sweep::rate_samples() {
  for (int first = 0; first < places_.count; first += lanes::kWidth) {
    branches_.rate([&](int i) { return places_.value(first + i); }, kNear,
                   &rows_[static_cast<std::size_t>(first)]);
  }
}

bool Sweep::take_answer(const SweptBranches::Row& off, double value) {
  if (least_of(off) > 0) return false;
  branches_.solve_all(value);
  for (int branch = 0; branch < lanes::kWidth; ++branch) {
    if (off[static_cast<std::size_t>(branch)] <= 0 && take(branch)) return true;
  }
  return false;
}

bool Sweep::take(int lane) {
  // What is rated as an answer is one but for rounding; or it is outside of limits where any angle
  // would do.
  if (branches_.off(lane) > kRounding) return false;
  branches_.copy_joints(lane, q_.data());
  const JointVector inside =
      joints_.clamp(Eigen::Map<const Eigen::VectorXd>(q_.data(), kCurveJoints));
  found_.assign(inside.begin(), inside.end());
  return true;
}

void Sweep::add_samples(int first, int stride, std::vector<double>& q,
                        std::vector<Sample>& samples) {
  // Eight places are rated in the time in which two or three are solved.
  const int count = (kSamples - first + stride - 1) / stride;
  SweptBranches::Row rows[lanes::kWidth];
  for (int i = 0; i < count; ++i) {
    const int lane_of_row = i % lanes::kWidth;
    const auto place_of = [&](int k) { return first + stride * std::min(k, count - 1); };
    if (lane_of_row == 0) {
      branches_.rate([&](int k) { return places_.value(place_of(i + k)); }, kNear, rows);
    }
    const SweptBranches::Row& off = rows[lane_of_row];
    const int place = place_of(i);
    rows_[static_cast<std::size_t>(place)] = off;
    if (least_of(off) > 0) continue;
    branches_.solve_all(places_.value(place));
    for (int lane = 0; lane < lanes::kWidth; ++lane) {
      if (branches_.off(lane) > 0) continue;
      branches_.copy_joints(lane, q_.data());
      q.insert(q.end(), q_.begin(), q_.end());
      samples.push_back({place, lane});
    }
  }
}

void Sweep::add_end(const Sample& inside, bool up, std::vector<double>& q) {
  constexpr int kRounds = 4;
  double from = places_.value(inside.place);
  double to = from + (up ? places_.step : -places_.step);
  for (int round = 0; round < kRounds; ++round) {
    const double step = (to - from) / (lanes::kWidth + 1);
    const auto value = [&](int lane) { return branches_.clamp(from + step * (lane + 1)); };
    branches_.solve_one(inside.branch, value);
    int count = 0;
    while (count < lanes::kWidth && branches_.off(count) <= 0) ++count;
    if (count > 0) {
      branches_.copy_joints(count - 1, q_.data());
      q.insert(q.end(), q_.begin(), q_.end());
    }
    from += step * count;
    to = from + step;
  }
}

void Sweep::visit_between(FunctionRef<void(const double* q, int branch)> visit) {
  find_nearest(0);
  for (const LeastPlace& near : nearest_) {
    Place place{near.value, places_.value(near.place), near.branch};
    if (follow(place, places_.step)) visit(q_.data(), near.branch);
  }
}

void Sweep::add_beside(const double* from, int branch, double part, std::vector<double>& q) {
  // Without the middle and the ends, which are samples.
  const double middle = from[branches_.joint()];
  const double spacing = part * kSpacingBeside * places_.step;
  branches_.solve_one(branch, [&](int lane) {
    const int place = lane < lanes::kWidth / 2 ? lane + 1 : lane + 2;
    return branches_.clamp(middle + spacing * (place - 1 / kSpacingBeside));
  });
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    if (branches_.off(lane) > 0) continue;
    branches_.copy_joints(lane, q_.data());
    q.insert(q.end(), q_.begin(), q_.end());
  }
}

bool Sweep::follow(Place& place, double width) {
  constexpr double kFinest = 1e-7;
  for (int round = 0; width > kFinest; ++round) {
    if (round > 0 && place.value > most_off(round)) break;
    const double spacing = 2 * width / (lanes::kWidth + 1);
    const double first = place.at - width + spacing;
    const auto at = [&](auto lane) {
      return branches_.clamp(first + spacing * static_cast<double>(lane));
    };
    double off[lanes::kWidth];
    if (rate(place.branch, at, off)) return true;
    const auto best = std::min_element(off, off + lanes::kWidth) - off;
    if (off[best] < place.value) place = {off[best], at(best), place.branch};
    width = spacing;
  }
  return false;
}

}  // namespace iksel
