// SPDX-License-Identifier: BSD-3-Clause
#include "search/collector.hpp"

#include <algorithm>
#include <utility>

#include "base/constants.hpp"
#include "refine/self_motion.hpp"
#include "seeds/fold_partner.hpp"

namespace iksel {
namespace {

/// Seeds in a row without a new solution after which a search has most likely found all. With 96,
/// an arm whose limits cut into its branches lost one in a pose of 170, with 128 in one of 300,
/// with 160 in one of 700 (bench/README.md).
constexpr int kStagnation = 160;
/// The same after all branches in closed form. What 400 seeds find besides are no solutions of
/// their own, but points of a curve that is one to within the tolerances (bench/README.md).
constexpr int kStagnationEnumerated = 8;
/// An image that lies no farther beyond a limit may have an answer at the limit beside it, where
/// the arm is almost singular [rad].
constexpr double kBesideLimit = 5e-3;

/// Where the images of an answer are wanted.
JointVector wanted_images(const JointSpace& joints, const SolveRequest& request,
                          const std::optional<NearestTo>& nearest_to) {
  if (nearest_to) return nearest_to->from;
  if (request.near && request.objective.kind != Objective::Kind::limits) return *request.near;
  return joints.middle();
}

}  // namespace

Collector::Collector(const Goal& goal, const SolveRequest& request, const Aim& aim,
                     FunctionRef<bool(const Collector&)> is_satisfied, int max_attempts,
                     CollectorMemory& memory)
    : SearchState(goal, request, max_attempts),
      model_(goal.robot()),
      aim_(aim),
      is_satisfied_(is_satisfied),
      found_(memory.found),
      partners_(memory.partners),
      nearest_to_(find_nearest_to(model_.dof, request)),
      coaxial_(wants_nearest() && memory.coaxial && memory.coaxial->has_any() ? &*memory.coaxial
                                                                              : nullptr),
      images_near_(wanted_images(model_.joints, request, nearest_to_)),
      // What a filter has been asked about stays as it is.
      counts_moves_(nearest_to_ && !screens_answers(request)),
      comes_in_pairs_(goal.is_full_pose() && model_.dof <= 6),
      basin_radius_(goal.is_full_pose() && model_.dof <= 6 ? kBasinRadius : 0.0) {
  found_.clear();
  partners_.clear();
}

Verdict Collector::offer(int /*lane*/, JointVector& q) {
  model_.joints.wrap(q.data());
  Result answer;
  Jacobian J;
  const bool pairs = comes_in_pairs_ && looks_for_partners_;
  goal_.measure(q, answer.position_error, answer.rotation_error, pairs ? &J : nullptr);
  if (!goal_.is_reached(answer.position_error, answer.rotation_error)) {
    note_rest(q);
    return Verdict::refine;
  }
  if (!model_.joints.contains(q.data())) {
    leave_limits();
    return Verdict::next;
  }
  answer.status = Status::solved;
  answer.q = q;
  wrap_near(images_near_, answer);
  share_turns(answer);
  const bool may_be_nearer = goal_.tips() != nullptr && ranks_by_move() &&
                             move_of(answer.q) < kWorthDescending * least_move();
  if (!keep(answer)) return Verdict::next;
  if (pairs) {
    look_for_partner(J, answer.q);
    paired_ = found_.size();
  }
  if (may_be_nearer) keep_nearer(answer);
  return Verdict::next;
}

bool Collector::keep(const Result& answer) {
  const double cost = counts_moves_ ? move_of(answer.q) : 0.0;
  if (!found_.add(answer, cost, aim_.min_distance)) return false;
  result_.status = Status::solved;
  last_new_ = work.attempts;
  return true;
}

void Collector::keep_nearer(Result answer) {
  JointVector q = answer.q;
  work.iterations += descend_to_near(goal_, nearest_to_->move, nearest_to_->from, q);
  if (!goal_.check(q, answer)) return;
  wrap_near(images_near_, answer);
  keep(answer);
}

void Collector::offer_near() {
  if (!request_.near || !goal_.is_solution(*request_.near)) return;
  JointVector q = *request_.near;
  offer(0, q);
}

void Collector::converge_from_near() {
  if (!nearest_to_ || has_converged_) return;
  has_converged_ = true;
  JointVector q = nearest_to_->from;
  if (converge(goal_, kStepsToNext, q)) offer(0, q);
}

void Collector::descend_from(JointVector q) {
  if (!converge(goal_, kStepsToNext, q)) return;
  work.iterations += descend_to_near(goal_, nearest_to_->move, nearest_to_->from, q);
  offer(0, q);
}

void Collector::descend_from_nearest(std::size_t most) {
  std::vector<std::pair<double, JointVector>> nearest;
  for (std::size_t i = 0; i < found_.size(); ++i) nearest.emplace_back(move_to(i), found_.at(i));
  const std::size_t count = std::min(most, nearest.size());
  std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count),
                    nearest.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < count; ++i) descend_from(nearest[i].second);
  settle(count > 0);
}

void Collector::wrap_near(const JointVector& near, Result& answer) const {
  const auto length = [&](const JointVector& d) {
    return nearest_to_ ? nearest_to_->move.length(d) : JointMove(model_.dof, request_).length(d);
  };
  const JointVector found = answer.q;
  JointVector image = found;
  const auto wrap = [&](double slack) {
    image = found;
    return model_.joints.wrap_nearest(near, slack, length, image);
  };
  // An answer at a limit lies outside by rounding as often as not. Held to the limit it need not be
  // a whole turn away.
  const bool is_held = wrap(goal_.task().rotation_tolerance());
  // Whole turns round, and so measured again.
  const bool is_answer = image == found || goal_.check(image, answer);
  if (is_answer) {
    if ((image - near).cwiseAbs().maxCoeff() <= kPi || !wrap(kBesideLimit)) return;
  } else if (!is_held) {
    return;
  }
  // Nor need the answer at the limit that the others make up for.
  const JointVector held = image;
  if (converge(goal_, kStepsToNext, image) &&
      (image - held).cwiseAbs().maxCoeff() < 2 * kBesideLimit && goal_.check(image, answer)) {
    return;
  }
  if (is_answer) return;
  wrap(0);
  goal_.check(image, answer);
}

void Collector::share_turns(Result& answer) const {
  if (coaxial_ == nullptr) return;
  JointVector q = answer.q;
  coaxial_->bring_nearest(nearest_to_->from, nearest_to_->move, q);
  Result shared = answer;
  if (goal_.check(q, shared)) answer = shared;
}

void Collector::look_for_partners(bool look) {
  looks_for_partners_ = look;
  if (!look || !comes_in_pairs_) return;
  for (; paired_ < found_.size(); ++paired_) {
    const JointVector q = found_.at(paired_);
    Jacobian J;
    goal_.model().fk_jacobian(q.data(), J);
    look_for_partner(J, q);
  }
}

bool Collector::is_singular(const JointVector& q) const {
  return !goal_.is_full_pose() || model_.dof > 6 || goal_.model().is_almost_singular(q.data());
}

void Collector::look_for_partner(const Jacobian& J, const JointVector& q) {
  // Of a pair that counts as one, the other may lie on the side of a limit where `near` is.
  FoldPartner partner =
      find_fold_partner(goal_.model(), J, q, request_.near ? 0.0 : aim_.min_distance);
  if (partner.paired && partners_.size() < partners_.capacity()) {
    partners_.push_back(std::move(partner.other));
  }
}

bool Collector::should_continue() {
  if (is_satisfied_(*this) || is_complete()) return false;
  is_out_of_time_ = deadline_.has_passed();
  return !is_out_of_time_;
}

bool Collector::pop_partner(JointVector& q) const {
  if (partners_.empty()) return false;
  q = partners_.back();
  partners_.pop_back();
  return true;
}

bool Collector::is_likely_complete() const {
  const int limit = has_all_branches_ ? kStagnationEnumerated : kStagnation;
  return has_any() && work.attempts - last_new_ >= limit;
}

}  // namespace iksel
