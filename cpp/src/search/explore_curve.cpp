// SPDX-License-Identifier: BSD-3-Clause
// All answers that are wanted of seven joints of which one can be swept: they lie on a self-motion.
// And of those of which none can the nearest.
#include "search/explore.hpp"
#include "seeds/free_samples.hpp"
#include "seeds/nearest_on_arcs.hpp"
#include "seeds/random_seeds.hpp"

namespace iksel {
namespace {

/// By what was sampled of it, answers or all but.
void refine_samples(const AllSearch& parts, bool are_answers) {
  const std::vector<double>& q = parts.workspace.lanes->samples.q;
  parts.refine_rows(q.data(), q.size() / kCurveJoints, are_answers, Width::wide);
}

/// Solutions all over it.
Explored explore_spread(const AllSearch& parts, const Pose& Y) {
  // Between points no farther apart, a straight line is near enough to the curve [rad].
  constexpr double kStraight = 0.3;
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  Collector& answers = parts.answers;
  std::vector<double>& q = lanes.samples.q;
  const auto wanted = static_cast<std::size_t>(answers.spread());
  const double least = 1.01 * answers.min_distance();
  if (parts.request.scene) {
    // Of what lies all over it none may be free where few are. None of these is refused, so that
    // half as many leave as much of a choice.
    FreeSamples free(*lanes.sweep, *parts.request.scene, Y, lanes.samples, parts.work, wanted / 2);
    if (parts.refine(Width::wide, free) || free.has_most()) return Explored::done();
  }
  lanes.sweep->find_spread(Y, wanted, least, q);
  parts.work.lap(&StageTimes::query);
  std::vector<double> few;
  if (q.size() < wanted * kCurveJoints) {
    few.swap(q);
  } else {
    refine_samples(parts, /*are_answers=*/true);
    if (answers.count() >= wanted) return Explored::done();
  }
  lanes.find_arcs(parts.goal.target(), Y, kStraight);
  // Where branches meet, some are the same.
  lanes.curve->spread(wanted + wanted / 4 + 8, least, q);
  parts.work.lap(&StageTimes::query);
  refine_samples(parts, /*are_answers=*/false);
  if (!few.empty() && answers.count() < wanted) {
    q.swap(few);
    refine_samples(parts, /*are_answers=*/true);
  }
  return answers.has_any() ? Explored::done() : explore_any(parts, Y, /*at_samples=*/false);
}

/// Refines the least moves to the curve, the nearest first, until one leads to such an answer;
/// where none does, once more without what is doubtful, which may have hidden another.
void refine_nearest(const AllSearch& parts, NearestOnCurve& curve, const Pose& Y) {
  // One beside a limit may be beyond it once it is refined, and a whole turn away.
  constexpr double kLost = 0.01;
  Collector& answers = parts.answers;
  double known = answers.move_to_beat();
  curve.find_between(known);
  const auto refine = [&] {
    parts.work.lap(&StageTimes::query);
    for (std::size_t i = 0; i < curve.size(); ++i) {
      parts.refine_rows(curve.q(i), 1, /*are_answers=*/true, Width::narrow);
      const double move = answers.least_move();
      if (move < known && move < curve.move(0) + kLost) return true;
    }
    return false;
  };
  bool has_led_to_answer = refine();
  known = answers.move_to_beat();
  if (curve.size() > 0 && curve.move(0) + kLost < known) {
    const auto& [near, move] = answers.nearest_to();
    curve.find(Y, near, move, known, /*takes_doubtful=*/false);
    has_led_to_answer = refine();
  }
  const bool is_too_far = answers.least_move() >= answers.within();
  answers.settle(curve.is_settled() && (has_led_to_answer || is_too_far));
}

/// Between points of arcs no farther apart, a straight line is near enough to the curve [rad].
constexpr double kSpacing = 0.05;

/// The solution nearest to it on the arcs that have ends, or that what was found lies on. Returns
/// whether that is known.
bool explore_arcs(const AllSearch& parts, const Pose& Y) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  Collector& answers = parts.answers;
  const double* known = answers.has_any() ? answers.solution(0) : nullptr;
  const std::vector<Curve::Arc>& arcs =
      lanes.find_arcs(parts.goal.target(), Y, kSpacing, known, answers.count());
  const auto& [near, move] = answers.nearest_to();
  const std::vector<NearPlace> places = find_nearest_on_arcs(arcs, parts.model.joints, near, move);
  for (const NearPlace& place : places) answers.descend_from(place.q);
  parts.work.lap(&StageTimes::query);
  return !places.empty() && answers.least_move() < places[0].move + off_lines(move);
}

/// Where there may be more than the curve, as it crosses another: down from around where the answer
/// is to be near to; and if that is nearer, or the curve is degenerate, on the arcs. Of 11,880
/// moves to poses with joints at limits and right angles 140 were longer by more than 0.01 rad
/// without it, with it 24, most of them to where a joint wider than a turn is at a limit, and
/// another joint at another (python -m bench moves --odd --poses 60 --seed 3100).
void explore_beside_curve(const AllSearch& parts, const Pose& Y, bool is_degenerate) {
  Collector& answers = parts.answers;
  const double before = answers.least_move();
  const JointVector& near = answers.nearest_to().from;
  const std::vector<double> q = sample_around(near, parts.options.seed, kNearby);
  parts.refine_rows(q.data(), kNearby, /*are_answers=*/false, Width::wide);
  answers.descend_from_nearest(kDescents);
  parts.work.lap(&StageTimes::iterate);
  const bool is_nearer = answers.least_move() < before - MoveBounds::kTooLittle;
  if (is_nearer || is_degenerate) explore_arcs(parts, Y);
}

/// The solution nearest to `near`, or to the objective's posture.
Explored explore_nearest(const AllSearch& parts, const Pose& Y) {
  // Where `near` itself leads bounds the others. Of 1,000 poses of `near` itself, the samples of
  // the curve alone led elsewhere in 5 (panda) to 16 (xarm7).
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  Collector& answers = parts.answers;
  NearestOnCurve& curve = *lanes.nearest_on_curve;
  const auto& [near, move] = answers.nearest_to();
  const bool stays = curve.prefers_staying(move);
  RowSeeds first(stays ? nullptr : &near, parts.work);
  search(lanes.refiner, first, answers, parts.work);
  const bool is_bounded = answers.within() < kInfinity;
  const bool is_seen =
      curve.find_at_samples(Y, near, move, answers.move_to_beat(), /*takes_doubtful=*/true);
  parts.work.lap(&StageTimes::query);
  // Where there is none, what looks for any is sooner through than what looks between samples.
  if (!is_seen && !answers.has_any() && !is_bounded) {
    const Explored any = explore_any(parts, Y, /*at_samples=*/false);
    if (any.is_done && !answers.has_any()) return any;
  }
  refine_nearest(parts, curve, Y);
  if (answers.least_move() < answers.within()) {
    const bool is_singular = parts.model.is_almost_singular(answers.solution(answers.nearest()));
    if (is_singular || curve.is_in_doubt()) {
      explore_beside_curve(parts, Y, is_singular || curve.is_degenerate());
    }
    return Explored::done();
  }
  if (is_bounded) return Explored::done();
  return is_seen ? explore_any(parts, Y) : Explored::doubtful();
}

/// The solutions nearest to it that pass the screen.
Explored explore_nearest_passing(const AllSearch& parts, Screen& screen, const Pose& Y) {
  /// So many of them are refined.
  constexpr std::size_t kMost = 16;
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  const std::vector<Curve::Arc>& arcs = lanes.find_arcs(parts.goal.target(), Y, kSpacing);
  std::vector<double>& q = lanes.samples.q;
  const auto& [near, move] = parts.answers.nearest_to();
  const auto passes = [&](const double* rows, std::size_t count, bool* keep) {
    screen.apply(rows, count, keep);
  };
  const bool has_any = find_nearest_passing(arcs, passes, parts.model.joints, near, move, kMost, q);
  parts.work.lap(&StageTimes::query);
  if (!has_any) return Explored::doubtful();
  refine_samples(parts, /*are_answers=*/false);
  if (!q.empty()) return Explored::done();
  // What a filter lets through may be but a little part of an arc.
  if (parts.request.filter) return Explored::doubtful();
  // One may be known all the same, or lie between the points.
  const auto knows_free = [&] {
    bool free = false;
    for (std::size_t i = 0; i < parts.answers.count() && !free; ++i) {
      screen.apply(parts.answers.solution(i), 1, &free);
    }
    return free;
  };
  FreeSamples samples(*lanes.sweep, *parts.request.scene, Y, lanes.samples, parts.work, kMost);
  if (knows_free() || parts.refine(Width::wide, samples) || knows_free()) return Explored::done();
  parts.answers.refuse();
  return Explored::done(Proof::sweep);
}

}  // namespace

void explore_families(const AllSearch& parts, const Pose& Y) {
  Collector& answers = parts.answers;
  if (parts.workspace.lanes->curve && explore_arcs(parts, Y)) {
    answers.settle(true);
    return;
  }
  answers.descend_from_nearest(kFamilyDescents);
  parts.work.lap(&StageTimes::iterate);
}

Explored explore_curve(const AllSearch& parts, const Pose& Y) {
  Collector& answers = parts.answers;
  if (answers.spread() > 0) return explore_spread(parts, Y);
  if (answers.wants_nearest()) return explore_nearest(parts, Y);
  if (!answers.wants_nearest_passing()) return Explored::doubtful();
  // Mostly the nearest of all passes.
  const Explored nearest = explore_nearest(parts, Y);
  Screen screen(parts.request, parts.model.dof);
  bool passes = false;
  if (answers.has_any()) screen.apply(answers.solution(answers.nearest()), 1, &passes);
  if (passes || nearest.proof != Proof::none) return nearest;
  answers.settle(false);
  return explore_nearest_passing(parts, screen, Y);
}

}  // namespace iksel
