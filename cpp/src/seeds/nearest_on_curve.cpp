// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/nearest_on_curve.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace iksel {

NearestOnCurve::NearestOnCurve(const ChainModel& model, const ClosedFormChain& chain,
                               bool is_nominal, const lanes::LaneKernels& kernels)
    : branches_(model, chain, kernels),
      places_(branches_.places(kSamples)),
      is_nominal_(is_nominal),
      packs_(kPacks) {}

double NearestOnCurve::least_move(double value) const {
  const auto i = static_cast<std::size_t>(branches_.joint());
  double d = value - near_[i];
  if (places_.turns) d = without_turns(d);
  return weight_[i] * std::abs(d);
}

bool NearestOnCurve::find_at_samples(const Pose& Y, const JointVector& near, const JointMove& move,
                                     double known) {
  std::copy_n(near.data(), SweptBranches::kDof, near_.begin());
  std::copy_n(move.weights().data(), SweptBranches::kDof, weight_.begin());
  takes_largest_ = move.norm() == MoveNorm::max;
  branches_.measure_moves_from(near, move);
  branches_.set_target(Y);
  places_ = branches_.places(kSamples);
  known_move_ = known;
  found_.clear();
  spans_left_ = kMostSpans;
  if (prefers_staying(move)) stay();
  stays_ = found_.size() > 0;
  return stays_ || look_around() < std::min(known, kRefused);
}

void NearestOnCurve::find_between(double known) {
  if (stays_) return;
  known_move_ = known;
  find_least_places();
  for (const LeastPlace& least : least_) {
    if (may_be_shorter(least)) follow(least);
  }
  look_between_samples();
}

bool NearestOnCurve::prefers_staying(const JointMove& move) const {
  constexpr double kFar = 1e4;
  const double own = move.weights()[branches_.joint()];
  for (int j = 0; j < SweptBranches::kDof; ++j) {
    if (j != branches_.joint() && kFar * move.weights()[j] > own) return false;
  }
  return move.norm() == MoveNorm::two;
}

void NearestOnCurve::stay() {
  // What is an answer but for rounding is one when it is refined [mixed units].
  constexpr double kRounding = 1e-6;
  double value = near_[static_cast<std::size_t>(branches_.joint())];
  if (places_.turns) value -= kTwoPi * std::floor((value - places_.lower) / kTwoPi);
  if (branches_.clamp(value) != value) return;
  branches_.solve_all(value);
  for (int lane = 0; lane < SweptBranches::kCount; ++lane) {
    if (branches_.off(lane) > kRounding) continue;
    SweptJoints found{branches_.moves().inside[lane], {}};
    branches_.copy_joints(lane, found.q.data());
    found_.add(found);
  }
}

double NearestOnCurve::look_around() {
  for (SamplePack& pack : packs_) pack.is_solved = false;
  exist_.fill(0);
  far_.fill(0);
  none_.fill(0);
  within_.fill(0);
  double best = std::min(known_move_, kRefused);
  const double from = near_[static_cast<std::size_t>(branches_.joint())] - places_.lower;
  const double start = places_.turns ? from - kTwoPi * std::floor(from / kTwoPi) : from;
  const double last = places_.count - 1;
  const int nearest = static_cast<int>(std::min(std::max(start / places_.step, 0.0), last));
  best = std::min(best, solve_pack(nearest / kCount, best));
  // Between these are the samples that are solved.
  int below = nearest / kCount * kCount - 1;
  int above = below + kCount + 1;
  while (above - below <= kSamples) {
    const int low = places_.find(below);
    const int high = places_.find(above);
    const double to_low = low < 0 ? kInfinity : least_move(places_.value(low));
    const double to_high = high < 0 ? kInfinity : least_move(places_.value(high));
    // Beside a sample that is farther away than the best move is long, there is nothing shorter.
    if (std::min(to_low, to_high) - margin_of_step() > best) return best;
    best = std::min(best, solve_pack((to_low <= to_high ? low : high) / kCount, best));
    if (to_low <= to_high) {
      below -= kCount;
    } else {
      above += kCount;
    }
  }
  return best;
}

double NearestOnCurve::solve_pack(int pack, double best) {
  SamplePack& samples = packs_[static_cast<std::size_t>(pack)];
  samples.is_solved = true;
  const int first = pack * kCount;
  const double most = best + kFarther;
  branches_.measure([&](int i) { return places_.value(first + i); }, kNear, most, samples.branch);
  for (std::size_t branch = 0; branch < kCount; ++branch) {
    const lanes::BranchRow& row = samples.branch[branch];
    within_[branch] |= row.within << first;
    for (int i = 0; i < kCount; ++i) {
      const Sample at{row, i, 0};
      const std::uint64_t bit = std::uint64_t{1} << (first + i);
      if (at.is_none()) {
        none_[branch] |= bit;
      } else if (at.is_far()) {
        far_[branch] |= bit;
      } else {
        exist_[branch] |= bit;
        best = std::min(best, cost(row.moves, i));
      }
    }
  }
  return best;
}

void NearestOnCurve::find_least_places() {
  least_.clear();
  for (int branch = 0; branch < kCount; ++branch) {
    std::uint64_t left = exist_[static_cast<std::size_t>(branch)];
    for (; left != 0; left &= left - 1) {
      const int place = __builtin_ctzll(left);
      const double here = cost(place, branch);
      if (here > kRefused + kNear) continue;
      if (here > cost(place - 1, branch) || here > cost(place + 1, branch)) continue;
      least_.add({here, place, branch});
    }
  }
}

bool NearestOnCurve::may_be_shorter(const LeastPlace& least) const {
  const double best = this->best();
  if (best == kInfinity) return true;
  if (least_move(places_.value(least.place)) - margin_of_step() > best) return false;
  if (least.value >= kRefused) {
    double loose = kInfinity;
    for (const int side : {-1, 0, 1}) {
      if (!is_known(least.place + side)) continue;
      loose = std::min(loose, sample(least.place + side, least.branch).loose());
    }
    return loose - kSteep < best;
  }
  // Between samples the move gets shorter by no more than it does from one to the next, or at the
  // end of the curve by a little more.
  constexpr double kAtEnd = 0.1;
  double change = 0;
  for (const int side : {-1, 1}) {
    const int beside = places_.find(least.place + side);
    if (beside < 0) continue;
    const bool is_far = is_known(beside) && sample(beside, least.branch).is_far();
    const double before = is_far ? best + kFarther : cost(beside, least.branch);
    change = std::max(change, before < kRefused ? before - least.value : kAtEnd);
  }
  return least.value - change < best;
}

void NearestOnCurve::follow(const LeastPlace& least) {
  const Bracket bracket{least.branch, places_.value(least.place), places_.step,
                        kNarrowings,  kFinest * places_.step,     !takes_largest_};
  // The sample itself may be all there is.
  add_least(
      bracket, [&](double place) { return branches_.clamp(place); },
      [&](double so_far, int round) { return is_hopeless(so_far, round); },
      point(sample(least.place, least.branch)));
}

void NearestOnCurve::add(const BranchPoint& point) {
  if (cost(point) >= kRefused + kCorner) return;
  SweptJoints found{point.inside, {}};
  branches_.copy_joints(point, found.q.data());
  found_.add(found);
}

bool NearestOnCurve::is_hopeless(double so_far, int round) const {
  // What is left to be gained after a round, and after two.
  constexpr double kLittle[] = {0.2, 0.03};
  // How far what leads to an answer may still be from one after a round, two and three.
  constexpr std::array<double, 3> kFarOff{0.2, 0.1, 0.05};
  if (round < 1 || best() == kInfinity) return false;
  if (so_far >= kRefused) {
    return so_far - kRefused > kFarOff[static_cast<std::size_t>(std::min(round, 3) - 1)];
  }
  return so_far - kLittle[std::min(round, 2) - 1] > best();
}

}  // namespace iksel
