// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/swept_branches.hpp"

#include <iterator>

namespace iksel {

SweptBranches::SweptBranches(const ChainModel& model, const ClosedFormChain& chain,
                             const lanes::LaneKernels& kernels)
    : chain_(chain),
      joints_(model.joints),
      kernels_(kernels),
      lower_(model.joints.sample_lower(chain.held)),
      upper_(model.joints.sample_upper(chain.held)),
      offset_(model.kernel.joints[static_cast<std::size_t>(chain.held)].offset),
      turns_(model.joints.is_periodic(chain.held)) {
  chain_.use_limits(model);
}

Places SweptBranches::places(int count) const {
  if (!turns_) return {lower_, (upper_ - lower_) / (count - 1), count, false};
  // Not at the limits, of which one image lies beyond.
  const double step = kTwoPi / count;
  return {lower_ + 0.5 * step, step, count, true};
}

void SweptBranches::set_target(const Pose& Y) {
  chain_.set_target(Y, all_);
  chain_.set_target(Y, one_);
  if (chain_.form.held_slide != 0) bound_slide();
}

void SweptBranches::bound_slide() {
  // The six others bring axis 6 no farther from axis 1 than their links are long.
  double longest = 0;
  for (const auto& link : chain_.form.p) longest += Eigen::Vector3d(link).norm();
  longest *= 1 + 1e-6;
  const Eigen::Vector3d axis(chain_.form.held_axis);
  const Eigen::Vector3d w(all_.target[9][0], all_.target[10][0], all_.target[11][0]);
  const double along = axis.dot(w);
  const double across2 = w.squaredNorm() - along * along;
  lower_ = joints_.lower[chain_.held];
  upper_ = joints_.upper[chain_.held];
  if (across2 >= longest * longest) return;
  const double half = std::sqrt(longest * longest - across2);
  const double lower = (along - half) / chain_.form.held_slide - offset_;
  const double upper = (along + half) / chain_.form.held_slide - offset_;
  // Where they overlap by nothing, there is no answer anywhere.
  if (lower >= upper_ || upper <= lower_) return;
  lower_ = std::max(lower_, lower);
  upper_ = std::min(upper_, upper);
}

void SweptBranches::solve_all(double value) {
  std::fill_n(all_.held, kCount, value + offset_);
  find_branches(all_);
  measure_moves();
}

BranchNode SweptBranches::node(int lane) const {
  BranchNode node{value(lane), least(lane), {}, {}};
  for (std::size_t j = 0; j < node.q.size(); ++j) {
    node.q[j] = last_->q[j][lane];
    const double beyond = std::abs(node.q[j] - chain_.form.middle[j]) - chain_.form.reach[j];
    node.beyond[j] = std::max(beyond, 0.0);
  }
  return node;
}

void SweptBranches::measure_moves_from(const JointVector& near, const JointMove& move) {
  measures_moves_ = true;
  lanes::MoveForm& form = move_form_;
  // An image at a limit may lie beyond it once it is refined.
  form.margin = 1e-5;
  form.takes_largest = move.norm() == MoveNorm::max;
  for (int i = 0; i < kDof; ++i) {
    const int j = i == kDof - 1 ? chain_.held : chain_.joints[i];
    const double offset = i == kDof - 1 ? offset_ : 0;
    form.from[i] = near[j] + offset;
    form.weight[i] = move.weights()[j];
    form.turns[i] = !joints_.is_slide(j);
    form.has_images[i] = joints_.is_periodic(j);
    form.lower[i] = joints_.lower[j] + form.margin + offset;
    form.upper[i] = joints_.upper[j] - form.margin + offset;
    form.turns_in_sum[i] = joints_.turns_in_sum(j);
  }
  form.sums = joints_.turning.empty() ? nullptr : chain_.form.sums;
}

void SweptBranches::rate(double bound, Row* rows) {
  double off[kCount][kCount];
  kernels_.rate_branches(chain_.form, all_, bound, off);
  for (std::size_t branch = 0; branch < kCount; ++branch) {
    for (std::size_t i = 0; i < kCount; ++i) rows[i][branch] = off[branch][i];
  }
}

void SweptBranches::find_branches(lanes::BranchPack& pack) {
  kernels_.find_branches(chain_.form, pack);
  last_ = &pack;
}

void SweptBranches::measure_moves() {
  if (measures_moves_) kernels_.measure_moves(move_form_, *last_, moves_);
}

void SweptBranches::narrow(int branch, int rounds, Fold& fold) {
  for (int round = 0; round < rounds; ++round) {
    const double step = (fold.outside - fold.inside) / (kCount + 1);
    const double from = fold.inside;
    const auto value = [&](int lane) { return from + step * (lane + 1); };
    hold_one(branch, value);
    find_branches(one_);
    for (int lane = 0; lane < kCount; ++lane) {
      if (least(lane) < 0) {
        fold.outside = value(lane);
        fold.least_outside = least(lane);
        break;
      }
      // What was before may not be known.
      const bool is_known = fold.least_inside > 0;
      fold.before = is_known ? fold.inside : value(lane);
      fold.least_before = fold.least_inside;
      fold.inside = value(lane);
      fold.least_inside = least(lane);
    }
  }
}

SweptBranches::Loop SweptBranches::find_loop(int branch, double lower, double upper,
                                             double least_lower, double least_upper) {
  constexpr int kRounds = 9;
  for (int round = 0; round < kRounds; ++round) {
    const double step = (upper - lower) / (kCount + 1);
    const double from = lower;
    hold_one(branch, [&](int lane) { return from + step * (lane + 1); });
    find_branches(one_);
    int best = 0;
    for (int lane = 1; lane < kCount; ++lane) {
      if (least(lane) > least(best)) best = lane;
    }
    const double here = least(best);
    if (here >= 0) {
      int first = best;
      int last = best;
      while (first > 0 && least(first - 1) >= 0) --first;
      while (last < kCount - 1 && least(last + 1) >= 0) ++last;
      return {value(best), from + step * first, from + step * (last + 2)};
    }
    if (best > 0) least_lower = least(best - 1);
    if (best < kCount - 1) least_upper = least(best + 1);
    // It rises by no more than beside the highest, and by half as much again where two subproblems
    // are in turn.
    if (here + MoveBounds::kCurved * (here - std::min(least_lower, least_upper)) < 0) break;
    lower = from + step * best;
    upper = from + step * (best + 2);
  }
  return {kInfinity, lower, upper};
}

double SweptBranches::Fold::end() const {
  // Where the parabola through the three values is 0; from where the line through the last two is.
  const double range = outside - inside;
  const double slope = (least_outside - least_inside) / range;
  const double straight = -least_inside / slope;
  if (before == inside) return inside + straight;
  const double slope_before = (least_inside - least_before) / (inside - before);
  const double bend = (slope - slope_before) / (outside - before);
  double way = straight;
  for (int step = 0; step < 2; ++step) {
    const double value = least_inside + way * (slope + bend * (way - range));
    const double steep = slope + bend * (2 * way - range);
    // A parabola that does not fall all the way says nothing.
    if (!(steep * range < 0)) return inside + straight;
    way = std::min(std::max((way - value / steep) / range, 0.0), 1.0) * range;
  }
  return inside + way;
}

}  // namespace iksel
