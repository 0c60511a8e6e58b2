// SPDX-License-Identifier: BSD-3-Clause
#include "search/answer_selector.hpp"

#include <algorithm>

#include "base/constants.hpp"
#include "goal/objective_cost.hpp"
#include "refine/self_motion.hpp"

namespace iksel {
namespace {

/// Seeds for the nearest where solutions come in families that are no curves that could be
/// followed: with 64, 5 of 2,820 moves of such random arms were longer than by brute force, with
/// 128 2, with 256 none (python -m bench random right_angles_7).
constexpr int kSeedsOfSurfaces = 256;
/// The best of solutions all over a self-motion that are brought to a least cost: of objectives of
/// random arms, 18 of 6,555 were then worse than the best of solve_all, with 2 26 of 6,650, with 4
/// 16 of 6,365; what else it changes says python -m bench constant.
constexpr std::size_t kSpreadDescents = 3;
/// Both of one tip's task that leaves axes free. Of 2,400 moves of random arms, free to spin or in
/// position only, 30 were longer than to the nearest of 256 solutions; with 64 and 4 89, in half
/// the time, with 256 and 16 3, in twice (python -m bench moves general offset_wrist
/// spherical_wrist srs elbow_offset wrist_offset --task spin --arms 10 --poses 20 --seed 5100, and
/// position).
constexpr int kSeedsOfTask = 128;
constexpr std::size_t kTaskDescents = 8;

}  // namespace

AnswerSelector::AnswerSelector(const Goal& goal, const SolveRequest& request,
                               const SolutionSet& found, Screen& screen)
    : goal_(goal),
      request_(request),
      ranks_(ranks_answers(request)),
      found_(found),
      nearest_to_(find_nearest_to(goal.robot().dof, request)),
      screen_(screen) {}

bool AnswerSelector::is_satisfied(const Collector& search) {
  screen_new();
  if (first_kept_ == found_.size()) return false;
  if (!ranks_) return true;
  // Of several tips there are as many seeds as the nearest needs.
  if (goal_.tips() != nullptr && search.wants_nearest()) return false;
  if (goal_.is_redundant()) {
    // As many as solve_all sees of its 64, so that none of its answers is better.
    if (!nearest_to_ && goal_.tips() == nullptr && search.spread() == 0) {
      return found_.size() >= std::size_t{kSeedsOfSurfaces} || search.is_likely_complete();
    }
    const int seeds = search.are_surfaces()  ? kSeedsOfSurfaces
                      : is_nearest_of_task() ? kSeedsOfTask
                                             : kRedundantSeeds;
    return search.work.attempts >= seeds;
  }
  return search.is_likely_complete();
}

bool AnswerSelector::select(const Collector& search, JointVector& q) {
  screen_new();
  if (first_kept_ == found_.size()) return select_image(kInfinity, q);
  if (!ranks_) {
    q = found_.at(first_kept_);
    return true;
  }
  std::array<Ranked, SolutionSet::kMost> ranked;
  std::size_t count = 0;
  for (std::size_t i = 0; i < found_.size(); ++i) {
    if (!kept_[i]) continue;
    const double cost = cost_of(found_.at(i));
    if (cost < kInfinity) ranked[count++] = {cost, i};
  }
  if (count == 0) return select_image(kInfinity, q);
  // Where not all solutions are known for certain, they may come in families.
  const bool is_in_doubt =
      nearest_to_ && !goal_.is_redundant() && search.result().proof == Proof::none;
  const bool is_redundant = goal_.is_redundant() && !search.is_settled();
  const std::size_t descents = std::min(count, is_redundant  ? descents_of_redundant(search)
                                               : is_in_doubt ? kFamilyDescents
                                                             : 1);
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(descents),
                    ranked.begin() + static_cast<std::ptrdiff_t>(count));
  q = found_.at(ranked[0].index);
  double best = ranked[0].cost;
  for (std::size_t k = 0; k < descents; ++k) {
    const JointVector from = found_.at(ranked[k].index);
    if (is_redundant || (is_in_doubt && search.is_singular(from))) descend_from(from, best, q);
  }
  // An image of one that was refused, or costs infinitely much, may be better still.
  if (count < found_.size()) select_image(best, q);
  return true;
}

std::size_t AnswerSelector::descents_of_redundant(const Collector& search) const {
  if (search.spread() > 0) return kSpreadDescents;
  return is_nearest_of_task() ? kTaskDescents : kDescents;
}

double AnswerSelector::cost_of(const JointVector& q) const {
  if (!ranks_) return 0;
  if (nearest_to_) return nearest_to_->move.length(q - nearest_to_->from);
  return ObjectiveCost(goal_.robot(), request_.objective).value(q);
}

void AnswerSelector::screen_new() {
  if (found_.replacements() != replacements_) asked_ = first_kept_ = 0;
  replacements_ = found_.replacements();
  if (asked_ < found_.size()) {
    const std::size_t count = found_.size() - asked_;
    screen_.find_free(found_.q(asked_), count, &free_[asked_]);
    std::copy_n(&free_[asked_], count, &kept_[asked_]);
    screen_.ask_filter(found_.q(asked_), count, &kept_[asked_]);
  }
  asked_ = found_.size();
  while (first_kept_ < asked_ && !kept_[first_kept_]) ++first_kept_;
}

void AnswerSelector::descend_from(JointVector end, double& best, JointVector& q) {
  if (nearest_to_) {
    steps_ += descend_to_near(goal_, nearest_to_->move, nearest_to_->from, end);
  } else {
    const ObjectiveCost objective(goal_.robot(), request_.objective);
    steps_ += descend_self_motion(goal_, JointCost(objective), /*most=*/50, end);
  }
  const double cost = cost_of(end);
  if (!(cost < best) || !goal_.is_solution(end)) return;
  bool keep = true;
  screen_.apply(end.data(), 1, &keep);
  if (!keep) return;
  best = cost;
  q = end;
}

bool AnswerSelector::select_image(double best, JointVector& q) {
  constexpr std::size_t kChunk = 64;
  const auto dof = static_cast<std::size_t>(goal_.robot().dof);
  std::array<double, kChunk* static_cast<std::size_t>(kMaxDof)> images{};
  std::size_t count = 0;
  bool any = false;
  const auto flush = [&] {
    std::array<bool, kChunk> keep{};
    keep.fill(true);
    screen_.ask_filter(images.data(), count, keep.data());
    for (std::size_t i = 0; i < count; ++i) {
      const JointVector image =
          Eigen::Map<const Eigen::VectorXd>(images.data() + i * dof, goal_.robot().dof);
      const double cost = cost_of(image);
      if (!keep[i] || !(cost < best)) continue;
      best = cost;
      q = image;
      any = true;
    }
    count = 0;
  };
  for (std::size_t i = 0; i < found_.size(); ++i) {
    // Whole turns change nothing about a collision.
    if (!free_[i]) continue;
    std::size_t left = kMostImages / found_.size();
    goal_.joints().visit_images(found_.at(i), [&](const JointVector& image) {
      if (cost_of(image) < best && goal_.is_solution(image)) {
        std::copy_n(image.data(), dof, images.data() + count * dof);
        if (++count == kChunk) flush();
      }
      return --left > 0;
    });
    leaves_out_ = leaves_out_ || left == 0 || !goal_.joints().upper.allFinite();
  }
  flush();
  return any;
}

}  // namespace iksel
