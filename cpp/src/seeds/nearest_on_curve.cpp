// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/nearest_on_curve.hpp"

#include <algorithm>
#include <cmath>

namespace iksel {
namespace {

/// Rounds of eight values in which a least is looked for, and a fold.
constexpr int kNarrowings = 9;
constexpr int kFoldRounds = 3;

/// The move to where the curve ends may be so much shorter than at the sample before.
constexpr double kSteep = 0.3;

/// The part of a sample's distance from the next to which a least is looked for.
constexpr double kFinest = 1e-5;

}  // namespace

NearestOnCurve::NearestOnCurve(const ChainModel& model, const ClosedFormChain& chain,
                               bool is_nominal, double tolerance, const lanes::LaneKernels& kernels)
    : branches_(model, chain, kernels),
      places_(branches_.places(kSamples)),
      joints_(model.joints),
      is_nominal_(is_nominal),
      miss_(is_nominal, tolerance),
      rows_(kSamples),
      samples_(kSamples) {}

NearestOnCurve::Move NearestOnCurve::move_to(int lane) const {
  std::array<double, SweptBranches::kDof> q;
  branches_.copy_joints(lane, q.data());
  Move move{0, 0};
  for (int j = 0; j < SweptBranches::kDof; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double d = q[i] - near_[i];
    double loose = d;
    double inside = d;
    if (std::abs(d) > kPi) {
      const auto turns = static_cast<double>(static_cast<long>(d / kTwoPi + (d > 0 ? 0.5 : -0.5)));
      loose = d - kTwoPi * turns;
      if (joints_.is_periodic(j)) {
        // An image at a limit may lie beyond it once it is refined.
        constexpr double kInside = 1e-5;
        const double least = std::ceil((joints_.lower[j] + kInside - q[i]) / kTwoPi);
        const double most = std::floor((joints_.upper[j] - kInside - q[i]) / kTwoPi);
        inside = d + kTwoPi * std::min(std::max(-turns, least), most);
      }
    }
    loose = std::abs(loose) * weight_[i];
    inside = std::abs(inside) * weight_[i];
    move.loose = takes_largest_ ? std::max(move.loose, loose) : move.loose + loose * loose;
    move.inside = takes_largest_ ? std::max(move.inside, inside) : move.inside + inside * inside;
  }
  if (takes_largest_) return move;
  return {std::sqrt(move.loose), std::sqrt(move.inside)};
}

double NearestOnCurve::cost(int lane) const {
  const double off = branches_.off(lane);
  return off > 0 ? kRefused + off : move_to(lane).inside;
}

double NearestOnCurve::least_move(double value) const {
  const auto i = static_cast<std::size_t>(branches_.joint());
  double d = value - near_[i];
  if (places_.turns) d = std::remainder(d, kTwoPi);
  return weight_[i] * std::abs(d);
}

void NearestOnCurve::find(const Pose& Y, const JointVector& near, const JointMove& move) {
  std::copy_n(near.data(), SweptBranches::kDof, near_.begin());
  std::copy_n(move.weights().data(), SweptBranches::kDof, weight_.begin());
  takes_largest_ = move.norm() == MoveNorm::max;
  branches_.set_target(Y);
  look_around();
  found_.clear();
  least_off_ = kInfinity;
  least_.find(places_, rows_, kRefused + kNear);
  for (const LeastPlace& least : least_) {
    if (may_be_shorter(least)) follow(least);
  }
  for (int branch = 0; branch < SweptBranches::kCount; ++branch) look_beside_folds(branch);
}

void NearestOnCurve::look_around() {
  for (int place = 0; place < places_.count; ++place) {
    rows_[static_cast<std::size_t>(place)].fill(kInfinity);
    samples_[static_cast<std::size_t>(place)].fill({});
  }
  double best = kRefused;
  const double from = near_[static_cast<std::size_t>(branches_.joint())] - places_.lower;
  const double start = places_.turns ? from - kTwoPi * std::floor(from / kTwoPi) : from;
  const double last = places_.count - (places_.turns ? 0 : 1);
  int below = static_cast<int>(std::min(std::max(start / places_.step, 0.0), last));
  int above = below + 1;
  for (int count = 0; count < places_.count; ++count) {
    const int low = places_.find(below);
    const int high = places_.find(above);
    const double to_low = low < 0 ? kInfinity : least_move(places_.value(low));
    const double to_high = high < 0 ? kInfinity : least_move(places_.value(high));
    // Beside a sample that is farther away than the best move is long, there is nothing shorter.
    if (std::min(to_low, to_high) - margin_of_step() > best) return;
    best = std::min(best, solve_at(to_low <= to_high ? low : high));
    if (to_low <= to_high) {
      --below;
    } else {
      ++above;
    }
  }
}

double NearestOnCurve::solve_at(int place) {
  branches_.solve_all(places_.value(place));
  double best = kInfinity;
  for (std::size_t i = 0; i < SweptBranches::kCount; ++i) {
    const int lane = static_cast<int>(i);
    Sample& sample = samples_[static_cast<std::size_t>(place)][i];
    sample.is_known = true;
    sample.exists = branches_.least(lane) >= 0;
    branches_.copy_joints(lane, sample.q.data());
    const Move move = move_to(lane);
    sample.loose = move.loose;
    const double off = branches_.off(lane);
    const double here = off > 0 ? kRefused + off : move.inside;
    rows_[static_cast<std::size_t>(place)][i] = here;
    best = std::min(best, here);
  }
  return best;
}

bool NearestOnCurve::may_be_shorter(const LeastPlace& least) const {
  if (found_.size() == 0) return true;
  const double best = found_[0].value;
  if (least_move(places_.value(least.place)) - margin_of_step() > best) return false;
  if (least.value >= kRefused) return true;
  // Between samples the move gets shorter by no more than it does from one to the next, or at the
  // end of the curve by a little more.
  constexpr double kAtEnd = 0.1;
  double change = 0;
  for (const int side : {-1, 1}) {
    const int beside = places_.find(least.place + side);
    if (beside < 0) continue;
    const double there =
        rows_[static_cast<std::size_t>(beside)][static_cast<std::size_t>(least.branch)];
    change = std::max(change, there < kRefused ? there - least.value : kAtEnd);
  }
  return least.value - change < best;
}

void NearestOnCurve::follow(const LeastPlace& least) {
  SweptJoints best{kInfinity, {}};
  double exists_at = kInfinity;
  const auto value = [&](double place) { return branches_.clamp(place); };
  const auto take = [&](int lane, double place) {
    branches_.copy_joints(lane, best.q.data());
    if (branches_.least(lane) >= 0) exists_at = place;
  };
  const Bracket bracket{least.branch, places_.value(least.place), places_.step,
                        kNarrowings,  kFinest * places_.step,     !takes_largest_};
  best.value = minimize(
      branches_, bracket, value, [&](int lane) { return cost(lane); }, kRefused, take,
      [&](double so_far, int round) { return is_hopeless(so_far, round); });
  // The sample itself may be all there is.
  if (least.value < best.value) best = {least.value, sample(least.place, least.branch).q};
  if (best.value < kRefused) {
    found_.add(best);
  } else {
    least_off_ = std::min(least_off_, best.value - kRefused);
  }
  if (exists_at == kInfinity || sample(least.place, least.branch).exists) return;
  if (sample(least.place - 1, least.branch).exists) return;
  if (sample(least.place + 1, least.branch).exists) return;
  // All of it lies between two samples, and the other joints turn a lot there.
  const double middle = places_.value(least.place);
  BranchSpan span{least.branch, branches_.clamp(middle - places_.step),
                  branches_.clamp(middle + places_.step), true, true};
  span.lower = branches_.find_fold(least.branch, exists_at, span.lower, kFoldRounds);
  span.upper = branches_.find_fold(least.branch, exists_at, span.upper, kFoldRounds);
  look_into(span, 3);
}

void NearestOnCurve::look_beside_folds(int branch) {
  for (int first = 0; first < places_.count; ++first) {
    if (!sample(first, branch).exists || sample(first - 1, branch).exists) continue;
    int last = first;
    double least = least_move(places_.value(first));
    while (sample(last + 1, branch).exists) {
      ++last;
      least = std::min(least, least_move(places_.value(last)));
      if (jumps(last, branch)) {
        look_into({branch, places_.value(last - 1), places_.value(last), false, false}, 1);
      }
    }
    if (found_.size() > 0 && least - margin_of_step() > found_[0].value) continue;
    BranchSpan span{branch, places_.value(first), places_.value(last),
                    sample(first - 1, branch).is_none(), sample(last + 1, branch).is_none()};
    const bool is_short = last - first < kShort;
    const bool below =
        span.folds_below && (is_short || may_lead_to_shorter(first, first - 1, branch));
    const bool above =
        span.folds_above && (is_short || may_lead_to_shorter(last, last + 1, branch));
    const double low = span.lower;
    const double high = span.upper;
    const int rounds = is_short ? 2 : 1;
    if (below) span.lower = branches_.find_fold(branch, low, low - places_.step, rounds);
    if (above) span.upper = branches_.find_fold(branch, high, high + places_.step, rounds);
    if (is_short && (below || above)) {
      look_into(span, 3);
      continue;
    }
    if (below) look_into({branch, span.lower, low, true, false}, 1);
    if (above) look_into({branch, high, span.upper, false, true}, 1);
  }
}

bool NearestOnCurve::jumps(int place, int branch) const {
  return may_lead_to_shorter(place, place - 1, branch) &&
         branches_.jumps(sample(place - 1, branch).q.data(), sample(place, branch).q.data());
}

bool NearestOnCurve::may_lead_to_shorter(int place, int beside, int branch) const {
  const double loose = std::min(sample(place, branch).loose, sample(beside, branch).loose);
  return found_.size() == 0 || loose - kSteep < found_[0].value;
}

bool NearestOnCurve::is_hopeless(double so_far, int round) const {
  // What is left to be gained after a round, and after two.
  constexpr double kLittle[] = {0.2, 0.03};
  return round >= 1 && found_.size() > 0 && so_far < kRefused &&
         so_far - kLittle[std::min(round, 2) - 1] > found_[0].value;
}

void NearestOnCurve::look_into(const BranchSpan& span, int packs) {
  constexpr int kMostPacks = 3;
  const int nodes = packs * SweptBranches::kCount;
  std::array<double, kMostPacks * SweptBranches::kCount> costs;
  const auto part = [&](int node) { return (node + 0.5) / nodes; };
  const auto value = [&](double p) { return span.value(std::min(std::max(p, 0.0), 1.0)); };
  for (int first = 0; first < nodes; first += SweptBranches::kCount) {
    branches_.solve_one(span.branch, [&](int lane) { return value(part(first + lane)); });
    for (int lane = 0; lane < SweptBranches::kCount; ++lane) {
      costs[static_cast<std::size_t>(first + lane)] = cost(lane);
    }
  }
  const auto at = [&](int node) {
    return node < 0 || node >= nodes ? kInfinity : costs[static_cast<std::size_t>(node)];
  };
  for (int node = 0; node < nodes; ++node) {
    if (at(node) > at(node - 1) || at(node) > at(node + 1)) continue;
    if (found_.size() > 0 && at(node) < kRefused && at(node) - kSteep > found_[0].value) continue;
    if (at(node) > kRefused + kNear) continue;
    SweptJoints best{kInfinity, {}};
    const auto take = [&](int lane, double) { branches_.copy_joints(lane, best.q.data()); };
    const Bracket bracket{span.branch, part(node),      1.0 / nodes,
                          kNarrowings, kFinest / nodes, !takes_largest_};
    best.value = minimize(
        branches_, bracket, value, [&](int lane) { return cost(lane); }, kRefused, take,
        [&](double so_far, int round) { return is_hopeless(so_far, round); });
    if (best.value < kRefused) found_.add(best);
  }
}

}  // namespace iksel
