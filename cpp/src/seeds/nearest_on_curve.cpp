// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/nearest_on_curve.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "base/constants.hpp"

namespace iksel {

NearestOnCurve::NearestOnCurve(const ChainModel& model, const ClosedFormChain& chain,
                               bool is_nominal, const lanes::LaneKernels& kernels)
    : branches_(model, chain, kernels),
      places_(branches_.places(kSamples)),
      is_nominal_(is_nominal),
      packs_(kSamples / lanes::kWidth) {}

double NearestOnCurve::least_move(double value) const {
  const double d = value - near_;
  return weight_ * std::abs(places_.turns ? without_turns(d) : d);
}

bool NearestOnCurve::find_at_samples(const Pose& Y, const JointVector& near, const JointMove& move,
                                     double known, bool takes_doubtful) {
  near_ = near[branches_.joint()];
  weight_ = move.weights()[branches_.joint()];
  takes_largest_ = move.norm() == MoveNorm::max;
  branches_.measure_moves_from(near, move, takes_doubtful);
  branches_.set_target(Y);
  places_ = branches_.places(kSamples);
  known_move_ = known;
  found_.clear();
  is_in_doubt_ = is_degenerate_ = false;
  spans_left_ = kMostSpans;
  if (prefers_staying(move)) stay();
  stays_ = found_.size() > 0;
  return stays_ || look_around() < std::min(known, kRefused);
}

void NearestOnCurve::find_between(double known) {
  if (stays_) return;
  known_move_ = known;
  Least<LeastPlace, 2 * kMost> places;
  for (int branch = 0; branch < lanes::kWidth; ++branch) {
    std::uint64_t left = exist_[static_cast<std::size_t>(branch)];
    for (; left != 0; left &= left - 1) {
      const int place = __builtin_ctzll(left);
      const double here = cost(place, branch);
      if (here > kRefused + kNear) continue;
      if (here > cost(place - 1, branch) || here > cost(place + 1, branch)) continue;
      places.add({here, place, branch});
    }
  }
  for (const LeastPlace& least : places) {
    if (may_be_shorter(least)) follow(least);
  }
  look_between_samples();
}

bool NearestOnCurve::prefers_staying(const JointMove& move) const {
  constexpr double kFar = 1e4;
  const double own = move.weights()[branches_.joint()];
  for (int j = 0; j < kCurveJoints; ++j) {
    if (j != branches_.joint() && kFar * move.weights()[j] > own) return false;
  }
  return move.norm() == MoveNorm::two;
}

void NearestOnCurve::stay() {
  // What is so little off is an answer when it is refined [mixed units].
  double value = near_;
  if (places_.turns) value -= kTwoPi * std::floor((value - places_.lower) / kTwoPi);
  if (branches_.clamp(value) != value) return;
  branches_.solve_all(value);
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    if (branches_.off(lane) <= kSameAnswer) add(branches_.point(lane));
  }
}

double NearestOnCurve::look_around() {
  for (SamplePack& pack : packs_) pack.is_solved = false;
  exist_.fill(0);
  far_.fill(0);
  none_.fill(0);
  within_.fill(0);
  double best = std::min(known_move_, kRefused);
  const double from = near_ - places_.lower;
  const double start = places_.turns ? from - kTwoPi * std::floor(from / kTwoPi) : from;
  const double last = places_.count - 1;
  const int nearest = static_cast<int>(std::min(std::max(start / places_.step, 0.0), last));
  best = std::min(best, solve_pack(nearest / lanes::kWidth, best));
  // Between these are the samples that are solved.
  int below = nearest / lanes::kWidth * lanes::kWidth - 1;
  int above = below + lanes::kWidth + 1;
  while (above - below <= kSamples) {
    const int low = places_.find(below);
    const int high = places_.find(above);
    const double to_low = low < 0 ? kInfinity : least_move(places_.value(low));
    const double to_high = high < 0 ? kInfinity : least_move(places_.value(high));
    // Beside a sample that is farther away than the best move is long, there is nothing shorter.
    if (std::min(to_low, to_high) - margin_of_step() > best) return best;
    best = std::min(best, solve_pack((to_low <= to_high ? low : high) / lanes::kWidth, best));
    if (to_low <= to_high) {
      below -= lanes::kWidth;
    } else {
      above += lanes::kWidth;
    }
  }
  return best;
}

double NearestOnCurve::solve_pack(int pack, double best) {
  SamplePack& samples = packs_[static_cast<std::size_t>(pack)];
  samples.is_solved = true;
  const int first = pack * lanes::kWidth;
  const double most = best + kFarther;
  branches_.measure([&](int i) { return places_.value(first + i); }, kNear, most, samples.branch);
  for (std::size_t branch = 0; branch < lanes::kWidth; ++branch) {
    const lanes::BranchRow& row = samples.branch[branch];
    within_[branch] |= row.within << first;
    // Without branches, as it is for all samples.
    for (int i = 0; i < lanes::kWidth; ++i) {
      const double off = row.moves.off[i];
      is_degenerate_ |= (std::abs(row.least[i]) < kRounding) | ((off > 0) & (off < kSameAnswer));
    }
    for (int i = 0; i < lanes::kWidth; ++i) {
      const std::uint64_t bit = std::uint64_t{1} << (first + i);
      if (row.least[i] < 0) {
        none_[branch] |= bit;
      } else if (row.moves.inside[i] >= lanes::kFarAway) {
        far_[branch] |= bit;
      } else {
        exist_[branch] |= bit;
        best = std::min(best, cost(row.moves.inside[i], row.moves.off[i]));
      }
    }
  }
  return best;
}

bool NearestOnCurve::may_be_shorter(const LeastPlace& least) const {
  const double best = this->best();
  if (best == kInfinity) return true;
  if (least_move(places_.value(least.place)) - margin_of_step() > best) return false;
  if (least.value >= kRefused) {
    double loose = kInfinity;
    for (const int side : {-1, 0, 1}) {
      if (!is_known(least.place + side)) continue;
      loose = std::min(loose, point(least.place + side, least.branch).loose);
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
    const bool is_far = is_known(beside) && point(beside, least.branch).is_far();
    const double before = is_far ? best + kFarther : cost(beside, least.branch);
    change = std::max(change, before < kRefused ? before - least.value : kAtEnd);
  }
  return least.value - change < best;
}

void NearestOnCurve::follow(const LeastPlace& least) {
  // What is left to be gained after a round, and after two.
  constexpr double kLittle[] = {0.2, 0.03};
  // The sample itself may be all there is.
  add_least({least.branch, -kInfinity, kInfinity}, places_.value(least.place), places_.step,
            point(least.place, least.branch), [&](double so_far, int round) {
              if (round < 1 || best() == kInfinity) return false;
              if (so_far < kRefused) return so_far - kLittle[std::min(round, 2) - 1] > best();
              return so_far - kRefused > most_off(round);
            });
}

void NearestOnCurve::add(const BranchPoint& point) {
  if (cost(point) >= kRefused + kCorner) return;
  is_in_doubt_ |= point.off > 0;
  SweptJoints found{point.inside, {}};
  branches_.copy_joints(point, found.q.data());
  found_.add(found);
}

void NearestOnCurve::add_least(const BranchSpan& span, double middle, double width,
                               const BranchPoint& best, FunctionRef<bool(double, int)> is_enough) {
  // What is left to be gained is not worth another round.
  constexpr double kGain = 1e-8;
  BranchPoint nearest = kNone;
  double least = kInfinity;
  // A guess is looked at closely; where it fails, the bracket is that of before.
  bool guessed = false;
  double at = middle;
  double behind = width;
  const double finest = kFinest * width;
  for (int round = 0; round < kNarrowings && width > finest; ++round) {
    if (is_enough(least, round)) break;
    const double spacing = 2 * width / (lanes::kWidth + 1);
    const auto place = [&](int lane) { return middle - width + spacing * (lane + 1); };
    branches_.solve_one(span.branch, [&](int lane) {
      return branches_.clamp(std::min(std::max(place(lane), span.lower), span.upper));
    });
    SweptBranches::Row costs;
    for (int lane = 0; lane < lanes::kWidth; ++lane) {
      costs[static_cast<std::size_t>(lane)] = cost(branches_.point(lane));
    }
    const auto best_lane =
        static_cast<int>(std::min_element(costs.begin(), costs.end()) - costs.begin());
    const double here = costs[static_cast<std::size_t>(best_lane)];
    const bool is_inside = best_lane > 0 && best_lane < lanes::kWidth - 1;
    if (here < least) {
      least = here;
      nearest = branches_.point(best_lane);
      middle = at = place(best_lane);
    }
    if (guessed && !(here == least && is_inside)) {
      // The guess was wrong.
      middle = at;
      width = behind;
      guessed = false;
      continue;
    }
    width = behind = spacing;
    guessed = false;
    if (!is_inside || takes_largest_) continue;
    // The cost is smooth but for where the branch ends: a parabola then tells where it is least.
    const double left = costs[static_cast<std::size_t>(best_lane - 1)];
    const double right = costs[static_cast<std::size_t>(best_lane + 1)];
    const double curvature = left - 2 * here + right;
    if (!(left < kRefused && right < kRefused && curvature > 0)) continue;
    if ((left - right) * (left - right) <= 8 * kGain * curvature * here) break;
    middle += 0.5 * (left - right) / curvature * spacing;
    width = 0.2 * spacing;
    guessed = true;
  }
  add(cost(best) < cost(nearest) ? best : nearest);
}

}  // namespace iksel
