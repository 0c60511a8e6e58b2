// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/swept_branches.hpp"

#include <utility>

#include "base/angle.hpp"

namespace iksel {
namespace {

MoveBounds::Straight find_straight(const lanes::ClosedForm& form) {
  MoveBounds::Straight straight;
  straight.fill(lanes::kUnknown);
  for (std::size_t i = 0; i + 1 < straight.size(); ++i) {
    // Where it turns axis i + 1 nearest to the one before it.
    const bool is_first = i == 0;
    if (is_first && form.held_slide != 0) continue;
    const Eigen::Vector3d before(is_first ? form.held_axis : form.h[i - 1]);
    const Eigen::Vector3d axis(form.h[i]);
    const Eigen::Vector3d behind(form.h[i + 1]);
    const double c = before.dot(axis) * axis.dot(behind);
    const double angle = std::atan2(before.dot(axis.cross(behind)), before.dot(behind) - c);
    const Eigen::AngleAxisd turn(angle, axis);
    const Eigen::Vector3d way = Eigen::Vector3d(is_first ? form.held_from : form.p[i - 1]) +
                                turn * Eigen::Vector3d(form.p[i]);
    const bool is_in_line = before.cross(turn * behind).norm() < kStructureTolerance &&
                            before.cross(way).norm() < kStructureTolerance;
    if (is_in_line) straight[i] = angle - form.offset[i];
  }
  return straight;
}

}  // namespace

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
  straight_ = find_straight(chain_.form);
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
  std::fill_n(all_.held, lanes::kWidth, value + offset_);
  solve(all_);
}

void SweptBranches::measure_moves_from(const JointVector& near, const JointMove& move,
                                       bool takes_doubtful) {
  measures_moves_ = true;
  lanes::MoveForm& form = move_form_;
  // An image at a limit may lie beyond it once it is refined, or inside.
  form.margin = 1e-5;
  const double inside = takes_doubtful ? -form.margin : form.margin;
  form.takes_largest = move.norm() == MoveNorm::max;
  for (int i = 0; i < kCurveJoints; ++i) {
    const int j = i == kCurveJoints - 1 ? chain_.held : chain_.joints[i];
    const double offset = i == kCurveJoints - 1 ? offset_ : 0;
    form.from[i] = near[j] + offset;
    form.weight[i] = move.weights()[j];
    form.turns[i] = !joints_.is_slide(j);
    form.has_images[i] = joints_.is_periodic(j);
    form.lower[i] = joints_.lower[j] + inside + offset;
    form.upper[i] = joints_.upper[j] - inside + offset;
    form.turns_in_sum[i] = joints_.turns_in_sum(j);
  }
  form.sums = joints_.turning.empty() ? nullptr : chain_.form.sums;
}

void SweptBranches::rate(double bound, Row* rows) {
  double off[lanes::kWidth][lanes::kWidth];
  kernels_.rate_branches(chain_.form, all_, bound, off);
  for (std::size_t branch = 0; branch < lanes::kWidth; ++branch) {
    for (std::size_t i = 0; i < lanes::kWidth; ++i) rows[i][branch] = off[branch][i];
  }
}

void SweptBranches::solve(lanes::BranchPack& pack) {
  kernels_.find_branches(chain_.form, pack);
  last_ = &pack;
  if (measures_moves_) kernels_.measure_moves(move_form_, pack, moves_);
}

MoveBounds::Joints SweptBranches::turns(const BranchPoint& from, const BranchPoint& to) const {
  const lanes::ClosedForm& form = chain_.form;
  // Along the chain: the swept joint, which is a point's last, comes first.
  const auto index = [](int i) { return static_cast<std::size_t>(i < 0 ? kCurveJoints - 1 : i); };
  MoveBounds::Joints turns{};
  int swings[kCurveJoints];
  int count = 0;
  for (int i = -1; i < kCurveJoints - 1; ++i) {
    const std::size_t at = index(i);
    const double d = to.q[at] - from.q[at];
    turns[at] = move_form_.turns[at] ? without_turns(d) : d;
    if (std::abs(turns[at]) > MoveBounds::kStill) swings[count++] = i;
  }
  if (count != 2) return turns;
  // Half a turn of one is half a turn of the other either way round, but for their axes.
  const auto [first, second] = std::pair(swings[0], swings[1]);
  const Eigen::Vector3d held(form.held_axis);
  Eigen::Vector3d axis(form.h[second]);
  for (int i = second - 1; i > first; --i) {
    const double angle = from.q[index(i)] + form.offset[i];
    axis = Eigen::AngleAxisd(angle, Eigen::Vector3d(form.h[i])) * axis;
  }
  const bool are_same = axis.dot(first < 0 ? held : Eigen::Vector3d(form.h[first])) > 0;
  const double against = are_same ? -turns[index(first)] : turns[index(first)];
  double& other = turns[index(second)];
  other = against + without_turns(other - against);
  return turns;
}

}  // namespace iksel
