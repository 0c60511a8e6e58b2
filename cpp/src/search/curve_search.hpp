// SPDX-License-Identifier: BSD-3-Clause
// Searches on the self-motion of seven joints of which one can be swept: all solutions lie on it.
#pragma once

#include <optional>
#include <vector>

#include "base/work.hpp"
#include "search/context.hpp"
#include "search/patience.hpp"
#include "search/search.hpp"
#include "seeds/free_samples.hpp"
#include "seeds/given_seeds.hpp"
#include "seeds/row_seeds.hpp"

namespace iksel {

template <typename Answers>
struct CurveSearch {
  const ChainModel& model;
  const Goal& goal;
  const SolveRequest& request;
  Workspace::InLanes& lanes;
  Answers& answers;
  Work& work;
  StageClock& clock;
  /// The target (reduction.hpp).
  const Pose& Y;

  // Each returns whether there certainly are no answers but those found; nothing if there may be
  // some left to search for.

  /// For a first answer: one that is free in the goal's scene.
  std::optional<Proof> find_free() const;
  /// For a Collector: what it wants, if that can be had here.
  std::optional<Proof> collect() const;

  // Parts of it.

  /// Searches by seeds that all but are answers. Returns whether the answers want no more.
  template <typename Seeds>
  bool refine(Seeds& seeds, Width width) const;
  /// By those that were sampled, answers or all but.
  void refine_rows(bool are_answers) const;
  /// Any solution, as soon as can be; true if there certainly is none.
  [[nodiscard]] bool collect_any_or_none() const;
  /// The solution nearest to `near`, or to the objective's posture.
  std::optional<Proof> collect_nearest() const;
  /// The free solutions nearest to it.
  std::optional<Proof> collect_nearest_free() const;
  /// Solutions all over it.
  std::optional<Proof> collect_spread() const;
};

template <typename Answers>
template <typename Seeds>
bool CurveSearch<Answers>::refine(Seeds& seeds, Width width) const {
  LaneRefiner& refiner = lanes.refiner;
  refiner.begin(goal.task(), kNearAnswer, width);
  const bool is_satisfied = search(refiner, seeds, answers, work);
  refiner.begin(goal.task(), kFirst, Width::narrow);
  clock.lap(&StageTimes::iterate);
  return is_satisfied;
}

template <typename Answers>
std::optional<Proof> CurveSearch<Answers>::find_free() const {
  if (answers.is_never_free()) {
    if (!answers.has_any() && !lanes.sweep->find(Y)) return std::nullopt;
    answers.refuse();
    return Proof::target;
  }
  FreeSamples samples(*lanes.sweep, *goal.scene(), Y, lanes.samples, work, clock);
  if (refine(samples, Width::narrow)) return Proof::none;
  if (!samples.has_any()) return std::nullopt;
  answers.refuse();
  return Proof::sweep;
}

template <typename Answers>
void CurveSearch<Answers>::refine_rows(bool are_answers) const {
  const std::vector<double>& q = lanes.samples.q;
  RowSeeds seeds(q.data(), q.size() / SweptBranches::kDof, SweptBranches::kDof, are_answers, work);
  refine(seeds, Width::wide);
}

template <typename Answers>
std::optional<Proof> CurveSearch<Answers>::collect_spread() const {
  // Between points no farther apart, a straight line is near enough to the curve [rad].
  constexpr double kStraight = 0.3;
  std::vector<double>& q = lanes.samples.q;
  const auto wanted = static_cast<std::size_t>(answers.spread());
  const double least = 1.01 * answers.min_distance();
  lanes.sweep->find_spread(Y, wanted, least, q);
  clock.lap(&StageTimes::query);
  refine_rows(/*are_answers=*/true);
  if (answers.count() >= wanted) return Proof::none;
  lanes.find_arcs(goal.target(), Y, kStraight);
  lanes.curve->spread(wanted + wanted / 4 + 8, least, q);
  clock.lap(&StageTimes::query);
  refine_rows(/*are_answers=*/false);
  if (answers.has_any()) return Proof::none;
  Sweep& sweep = *lanes.sweep;
  if (q.empty() && !sweep.find(Y) && sweep.is_none()) return Proof::sweep;
  return std::nullopt;
}

template <typename Answers>
std::optional<Proof> CurveSearch<Answers>::collect_nearest_free() const {
  constexpr double kSpacing = 0.05;
  /// So many of them are refined.
  constexpr std::size_t kMost = 16;
  const std::vector<Curve::Arc>& arcs = lanes.find_arcs(goal.target(), Y, kSpacing);
  std::vector<double>& q = lanes.samples.q;
  const auto& [near, move] = answers.nearest_to();
  const bool has_any = find_nearest_free(arcs, *request.scene, model.joints, near, move, kMost, q);
  clock.lap(&StageTimes::query);
  if (!has_any) return std::nullopt;
  refine_rows(/*are_answers=*/false);
  if (!q.empty()) return Proof::none;
  answers.status = Status::in_collision;
  return Proof::sweep;
}

template <typename Answers>
std::optional<Proof> CurveSearch<Answers>::collect() const {
  if (answers.spread() > 0) return collect_spread();
  if (answers.wants_nearest_free()) {
    // Mostly the nearest of all is free.
    const std::optional<Proof> proof = collect_nearest();
    bool is_free = false;
    if (answers.has_any()) {
      request.scene->find_free(answers.solution(answers.nearest()), 1, &is_free);
    }
    if (is_free || proof == Proof::sweep) return proof;
    answers.is_settled = false;
    return collect_nearest_free();
  }
  if (answers.wants_nearest()) return collect_nearest();
  return std::nullopt;
}

template <typename Answers>
bool CurveSearch<Answers>::collect_any_or_none() const {
  Sweep& sweep = *lanes.sweep;
  const bool is_found = sweep.find(Y);
  clock.lap(&StageTimes::query);
  if (!is_found) return sweep.is_none();
  RowSeeds answer(sweep.q(), 1, SweptBranches::kDof, /*are_answers=*/true, work);
  refine(answer, Width::narrow);
  return false;
}

template <typename Answers>
std::optional<Proof> CurveSearch<Answers>::collect_nearest() const {
  // Where `near` itself leads bounds the others. Of 1,000 poses of `near` itself, the samples of
  // the curve alone led elsewhere in 5 (panda) to 16 (xarm7).
  LaneRefiner& refiner = lanes.refiner;
  NearestOnCurve& curve = *lanes.nearest_on_curve;
  const auto& [near, move] = answers.nearest_to();
  const bool stays = curve.prefers_staying(move);
  NearSeed first(stays ? nullptr : &near, work);
  search(refiner, first, answers, work);
  // Any answer bounds the others as well, and where there is none, what looks for any is sooner
  // through.
  if (!stays && !answers.has_any() && collect_any_or_none()) return Proof::sweep;
  NearestOnCurveSeeds nearest(curve, Y, near, move, answers, work, clock);
  refine(nearest, Width::narrow);
  answers.is_settled = curve.is_settled() && nearest.has_led_to_answer();
  if (stays && !answers.has_any() && collect_any_or_none()) return Proof::sweep;
  return answers.has_any() ? std::optional(Proof::none) : std::nullopt;
}

}  // namespace iksel
