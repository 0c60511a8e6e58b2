// SPDX-License-Identifier: BSD-3-Clause
#include "tree/tree_seeds.hpp"

#include <algorithm>
#include <cmath>

#include "base/low_discrepancy.hpp"

namespace iksel {
namespace {

/// Values of the shared joints that are tried before all joints are iterated.
constexpr int kSharedValues = 32;
/// Values at which the nearest is looked for, at most, and after the last that gave a nearer one.
constexpr int kNearValues = 48;
constexpr int kNearPatience = 16;

}  // namespace

SharedValues::SharedValues(const TreeModel& model, const NearBound* bound)
    : model_(model),
      bound_(bound),
      index_(bound != nullptr ? -1 : 0),
      step_(low_discrepancy_steps(model.shared.size())) {}

std::pair<double, double> SharedValues::range(int joint) const {
  const JointSpace& joints = model_.joints;
  double lower = joints.sample_lower(joint);
  double upper = joints.sample_upper(joint);
  if (bound_ == nullptr) return {lower, upper};
  const double weight = bound_->move.weights()[joint];
  if (!(weight > 0) || bound_->best == kInfinity) return {lower, upper};
  const double reach = bound_->best / weight;
  const double near = bound_->near[joint];
  if (joints.type(joint) == JointType::continuous && reach < kPi)
    return {near - reach, near + reach};
  lower = std::max(lower, std::min(near - reach, upper));
  return {lower, std::max(lower, std::min(near + reach, upper))};
}

void SharedValues::hold_coupled(JointVector& q) const {
  for (const TreeTip& tip : model_.tips) {
    if (!tip.stem) continue;
    const auto& [stem, joints] = *tip.stem;
    if (stem.options().coupled_limits.empty()) continue;
    put(stem.model().joints.clamp(picked(q, joints)), joints, q);
  }
}

void SharedValues::next(JointVector& q) {
  if (index_ < 0) {
    for (const int joint : model_.shared) q[joint] = bound_->near[joint];
    q = model_.joints.clamp(q);
  } else {
    for (std::size_t j = 0; j < model_.shared.size(); ++j) {
      const auto [lower, upper] = range(model_.shared[j]);
      // The first is the middle.
      const double x = 0.5 + index_ * step_[j];
      q[model_.shared[j]] = lower + (upper - lower) * (x - std::floor(x));
    }
    hold_coupled(q);
  }
  ++index_;
}

ArmSeeds::ArmSeeds(const StackedGoal& goal, ArmSearch& arms, const NearBound* bound, Work& work)
    : goal_(goal),
      arms_(arms),
      bound_(bound),
      work_(work),
      values_(goal.model(), bound),
      left_(bound != nullptr ? kNearValues : kSharedValues),
      patience_(kNearPatience),
      q_(goal.model().joints.middle()) {
  if (goal.model().shared.empty()) left_ = 1;
  if (!arms.has_all_arms()) left_ = 0;
}

bool ArmSeeds::next_stage() {
  is_complete_ = false;
  if (bound_ != nullptr && bound_->best < last_best_) {
    last_best_ = bound_->best;
    patience_ = kNearPatience;
  }
  if (left_ == 0 || patience_ == 0 || !work_.take()) return false;
  --left_;
  if (last_best_ < kInfinity) --patience_;
  values_.next(q_);
  const int tips = goal_.model().tip_count();
  unsigned solved = 0;
  for (int k = 0; k < tips; ++k) {
    const int tip = (first_ + k) % tips;
    if (is_too_far(solved)) return true;
    if (!arms_.solve_arm(tip, q_)) {
      first_ = tip;
      return true;
    }
    solved |= 1U << static_cast<unsigned>(tip);
  }
  is_complete_ = true;
  return true;
}

bool ArmSeeds::is_too_far(unsigned solved) const {
  if (bound_ == nullptr || bound_->best == kInfinity) return false;
  JointVector moved = bound_->near;
  for (const int joint : goal_.model().shared) moved[joint] = q_[joint];
  for (int tip = 0; tip < goal_.model().tip_count(); ++tip) {
    if ((solved & (1U << static_cast<unsigned>(tip))) == 0) continue;
    for (const int joint : goal_.model().tip(tip).arm->joints) moved[joint] = q_[joint];
  }
  return bound_->move.length(moved - bound_->near) >= bound_->best;
}

bool StackedSeeds::next_stage() {
  if (!work_.take()) return false;
  const int tips = goal_.model().tip_count();
  is_loaded_ = make_from_chain(index_ % tips, /*at_random=*/index_ >= tips);
  ++index_;
  return is_loaded_;
}

bool StackedSeeds::make_from_chain(int lead, bool at_random) {
  q_.resize(goal_.model().dof());
  goal_.model().joints.sample(random_, q_);
  const Result of_chain = arms_.solve_chain(lead, at_random, q_);
  if (!of_chain.success() && !at_random) {
    result_.status = of_chain.status;
    result_.proof = of_chain.proof;
    result_.unreachable_tip = lead;
    return false;
  }
  for (int tip = 0; tip < goal_.model().tip_count(); ++tip) {
    if (tip != lead) arms_.bring_closest(tip, q_);
  }
  return true;
}

}  // namespace iksel
