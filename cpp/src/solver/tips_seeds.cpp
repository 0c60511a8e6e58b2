// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tips_seeds.hpp"

#include <algorithm>
#include <cmath>

namespace iksel {
namespace {

/// Values of the shared joints that are tried before all joints are iterated, with little work and
/// with all. Of 16, 48, 96 and 256 tried with little, two Pandas
/// took 15.0, 13.3, 12.1 and 12.4 us in the mean (python -m bench whole_body two_pandas).
constexpr int kQuickValues = 96;
constexpr int kSharedValues = 32;
/// Where many answers are wanted; and values at which the nearest is looked for where it may be
/// anywhere within the limits, if the arms' nearest are known. Of 1,500 moves of random pairs of
/// arms on a joint, from anywhere, 13 were longer than by 1,500 values with 192, 10 with 256 and 7
/// with 384, before kWorthDescending; with it 5 with 224 and 4 with 256 (moves as of python -m
/// bench hands pairs).
constexpr int kManyValues = 256;
/// The same of several joints, with kNearby seeds around. Of 800 moves of random pairs on two and
/// three, from anywhere, 59 were longer than known with 256 and no seeds, 32 with these in four
/// fifths of the time (moves as of python -m bench hands pairs --shared 3).
constexpr int kSparseValues = 128;
/// Seeds of one chain each, after the first values.
constexpr int kChainSeeds = 24;
/// Combinations of the arms' solutions behind one value, at most.
constexpr std::size_t kCombinations = 256;
/// Of those that are free, so many of the nearest, where the nearest is wanted; so many where many
/// are: the others lie behind other values, if there are some.
constexpr std::size_t kNearestKept = 4;
constexpr std::size_t kManyKept = 16;

/// How many solutions of each of so many arms give kCombinations.
int solutions_of_each(int arms) {
  int each = 1;
  while (std::pow(each + 1, arms) <= double{kCombinations}) ++each;
  return each;
}

}  // namespace

SharedValues::SharedValues(const TipsModel& model, const std::vector<double>& steps, int most,
                           const NearestTo* to)
    : model_(model),
      to_(to),
      most_(most),
      index_(to != nullptr && most > 1 ? -1 - 2 * static_cast<int>(model.shared.size()) : 0),
      steps_(steps) {}

std::pair<double, double> SharedValues::range(int joint, double best) const {
  const JointSpace& joints = model_.joints;
  double lower = joints.sample_lower(joint);
  double upper = joints.sample_upper(joint);
  if (to_ == nullptr) return {lower, upper};
  const double weight = to_->move.weights()[joint];
  if (!(weight > 0) || best == kInfinity) return {lower, upper};
  const double reach = best / weight;
  const double near = to_->from[joint];
  if (joints.type(joint) == JointType::continuous && reach < kPi)
    return {near - reach, near + reach};
  lower = std::max(lower, std::min(near - reach, upper));
  return {lower, std::max(lower, std::min(near + reach, upper))};
}

void SharedValues::hold_stems(JointVector& q) const {
  for (const Tip& tip : model_.tips) {
    if (!tip.stem) continue;
    const auto& [stem, joints] = *tip.stem;
    put(stem.model().joints.clamp(picked(q, joints)), joints, q);
  }
}

bool SharedValues::next(double best, JointVector& q) {
  const int count = static_cast<int>(model_.shared.size());
  for (int j = 0; j < count; ++j) {
    const int joint = model_.shared[static_cast<std::size_t>(j)];
    const auto [lower, upper] = range(joint, best);
    // The first is the middle.
    const double x = 0.5 + index_ * steps_[static_cast<std::size_t>(j)];
    if (index_ >= 0) q[joint] = lower + (upper - lower) * (x - std::floor(x));
    if (index_ < 0 && (-index_ - 1) / 2 == j) q[joint] = index_ % 2 == 0 ? lower : upper;
  }
  if (index_ >= most_ * part(best)) return false;
  hold_stems(q);
  ++index_;
  return true;
}

ArmSeeds::ArmSeeds(const Goal& goal, ArmSearch& arms, const std::vector<double>& steps,
                   Effort effort, const Collector* collector, Work& work)
    : goal_(goal),
      model_(goal.tips()->model()),
      arms_(arms),
      effort_(effort),
      collector_(collector),
      work_(work),
      to_(collector != nullptr && collector->ranks_by_move() ? &collector->nearest_to() : nullptr),
      knows_nearest_(knows_nearest(arms, collector)),
      values_(model_, steps,
              model_.shared.empty()                               ? 1
              : wants_many()                                      ? kManyValues
              : knows_nearest_ && SharedValues::are_dense(model_) ? kManyValues
              : knows_nearest_                                    ? kSparseValues
              : to_ == nullptr && effort == Effort::quick         ? kQuickValues
                                                                  : kSharedValues,
              to_),
      order_(goal.tips()->order()) {
  // Of arms that only a sum couples, some of their solutions may go together.
  const bool go_together =
      effort == Effort::full && model_.shared.empty() && !model_.joints.sums.empty();
  const bool may_refuse =
      goal.scene() != nullptr || (to_ != nullptr && !collector->wants_nearest());
  const bool combines = wants_many() || may_refuse || go_together;
  of_each_ = combines ? solutions_of_each(model_.tip_count()) : 1;
}

bool ArmSeeds::next_stage() {
  seeds_.clear();
  next_ = 0;
  if (!arms_.has_all_arms() || !work_.has_left()) return false;
  JointVector q = to_ != nullptr ? to_->from : model_.joints.middle();
  // What was found may all be refused.
  const bool bounds = to_ != nullptr && (collector_->wants_nearest() || effort_ == Effort::quick);
  const double best = bounds ? collector_->least_move() : kInfinity;
  if (best < last_best_) {
    // Behind its own values there may be a nearer one.
    last_best_ = best;
    q = Eigen::Map<const Eigen::VectorXd>(collector_->solution(collector_->nearest()), q.size());
  } else if (!values_.next(last_best_, q)) {
    return false;
  }
  work_.take();
  if (!knows_nearest_) behind_.clear();
  behind_.push_back({q, std::vector<std::optional<std::vector<JointVector>>>(order_.size())});
  failed_ = 0;
  extend(0, q);
  const bool are_apart = std::all_of(order_.begin(), order_.end(),
                                     [&](int tip) { return goal_.tips()->stands_still(tip); });
  if (seeds_.empty() && are_apart) {
    std::rotate(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(failed_),
                order_.end());
  }
  sort_out();
  if (knows_nearest_) add_between();
  return true;
}

void ArmSeeds::extend(std::size_t k, JointVector q) {
  if (left(k, q) == 0 || seeds_.size() >= kCombinations) return;
  if (k == order_.size()) {
    if (!knows_nearest_ || !collector_->has_beside(q, kBasinRadius) ||
        to_->move.length(q - to_->from) < last_best_) {
      seeds_.push_back(q);
    }
    return;
  }
  const int tip = order_[k];
  const std::vector<JointVector>& solutions = solve(tip, q, behind_.back());
  if (solutions.empty()) failed_ = k;
  for (const JointVector& solution : solutions) {
    put(solution, model_.tip(tip).arm->joints, q);
    extend(k + 1, q);
  }
}

const std::vector<JointVector>& ArmSeeds::solve(int tip, const JointVector& q, Behind& behind) {
  auto& found = behind.arms[static_cast<std::size_t>(tip)];
  // Of a target that stands still they are the same whatever the other arms do.
  if (found && goal_.tips()->stands_still(tip)) return *found;
  found.emplace();
  // Where the nearest is known it is found, or that there is none, at once.
  const bool is_quick = effort_ == Effort::quick && !knows_nearest_;
  JointVector solved = q;
  if (is_quick && !arms_.solve_arm(tip, Effort::quick, kInfinity, solved)) return *found;
  // Which answer matters to those who collect.
  const bool will_do = is_quick && collector_ == nullptr;
  if (of_each_ > 1) {
    *found = arms_.solve_arm(tip, q, of_each_);
  } else if (const double within = knows_nearest_ ? left(0, q) : kInfinity;
             will_do || arms_.solve_arm(tip, Effort::full, within, solved)) {
    found->push_back(picked(solved, model_.tip(tip).arm->joints));
  }
  return *found;
}

void ArmSeeds::add_between() {
  Behind& last = behind_.back();
  for (const int joint : model_.shared) {
    for (const int side : {-1, 1}) {
      Behind* beside = nullptr;
      double least = kInfinity;
      for (Behind& other : behind_) {
        const JointVector way = picked(other.q - last.q, model_.shared);
        if (side * (other.q[joint] - last.q[joint]) <= 0 || !(way.norm() < least)) continue;
        least = way.norm();
        beside = &other;
      }
      if (beside == nullptr) continue;
      for (unsigned tips = 1; tips + 1 < 1U << order_.size(); ++tips) {
        add_mixed(last, *beside, tips);
      }
    }
  }
}

void ArmSeeds::add_mixed(Behind& a, Behind& b, unsigned tips_of_b) {
  JointVector q = 0.5 * (a.q + b.q);
  bool jumps[2] = {};
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const int tip = order_[k];
    const bool is_of_b = (tips_of_b >> tip & 1U) != 0;
    const std::vector<JointVector>& here = solve(tip, is_of_b ? b.q : a.q, is_of_b ? b : a);
    if (here.empty()) return;
    const auto& there = (is_of_b ? a : b).arms[static_cast<std::size_t>(tip)];
    jumps[is_of_b] |= !there || there->empty() ||
                      (here.front() - there->front()).cwiseAbs().maxCoeff() > kBasinRadius;
    put(here.front(), model_.tip(tip).arm->joints, q);
    if (left(k + 1, q) == 0) return;
  }
  if (jumps[0] && jumps[1]) seeds_.push_back(q);
}

void ArmSeeds::sort_out() {
  if (goal_.scene() != nullptr && !arms_.may_collide()) {
    seeds_.erase(std::remove_if(seeds_.begin(), seeds_.end(),
                                [&](const JointVector& q) { return !goal_.is_free(q); }),
                 seeds_.end());
  }
  if (of_each_ == 1) return;
  keep_sums();
  if (collector_ == nullptr) return;
  // Of what a filter has not seen yet more are tried.
  const bool is_filtered = static_cast<bool>(collector_->request().filter);
  const std::size_t kept = to_ != nullptr && !is_filtered ? kNearestKept
                           : model_.shared.empty()        ? kCombinations
                                                          : kManyKept;
  const std::size_t most = std::min(seeds_.size(), kept);
  if (to_ != nullptr) {
    const auto length = [&](const JointVector& q) { return to_->move.length(q - to_->from); };
    std::stable_sort(seeds_.begin(), seeds_.end(),
                     [&](const auto& a, const auto& b) { return length(a) < length(b); });
  } else if (most > 0) {
    // Some of all: their order is that of the first arm's solutions.
    for (std::size_t i = 0; i < most; ++i) seeds_[i] = seeds_[i * seeds_.size() / most];
  }
  seeds_.resize(most);
}

void ArmSeeds::keep_sums() {
  const JointSpace& joints = model_.joints;
  if (joints.sums.empty()) return;
  for (JointVector& q : seeds_) joints.wrap_sums(q.data());
  const auto beyond =
      std::stable_partition(seeds_.begin(), seeds_.end(),
                            [&](const JointVector& q) { return joints.contains(q.data()); });
  if (beyond != seeds_.begin()) seeds_.erase(beyond, seeds_.end());
}

double ArmSeeds::left(std::size_t arms, const JointVector& q) const {
  if (to_ == nullptr || last_best_ == kInfinity) return kInfinity;
  JointVector moved = to_->from;
  for (const int joint : model_.shared) moved[joint] = q[joint];
  for (std::size_t k = 0; k < arms; ++k) {
    for (const int joint : model_.tip(order_[k]).arm->joints) moved[joint] = q[joint];
  }
  return to_->move.rest(kWorthDescending * last_best_, to_->move.length(moved - to_->from));
}

bool ChainSeeds::next_stage() {
  const bool is_quick = effort_ == Effort::quick;
  if ((is_quick && index_ == kChainSeeds) || is_enough_() || !work_.take()) return false;
  const int lead = index_ % goal_.count();
  const bool at_random = is_quick || index_ >= goal_.count();
  ++index_;
  q_ = goal_.model().joints.sample(random_);
  const Result of_chain = arms_.solve_chain(lead, effort_, at_random, q_);
  // What is seen from another tip depends on where that is.
  if (!of_chain.success() && !at_random && goal_.frame_of(lead) < 0) {
    proof_ = unreachable_(lead, of_chain);
    return false;
  }
  const bool is_of_use = of_chain.success() || !is_quick;
  if (is_of_use) bring_others(lead);
  give(q_.data(), is_of_use ? 1 : 0, 0, /*are_answers=*/false);
  return true;
}

void ChainSeeds::bring_others(int lead) {
  for (const int tip : goal_.order()) {
    if (tip == lead) continue;
    if (effort_ == Effort::full) {
      arms_.bring_closest(tip, q_);
    } else if (arms_.has_arm(tip)) {
      arms_.solve_arm(tip, effort_, kInfinity, q_);
    }
  }
}

}  // namespace iksel
