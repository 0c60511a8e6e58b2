// SPDX-License-Identifier: BSD-3-Clause
// All answers to a full pose that are wanted, in lanes.
#include "search/explore.hpp"
#include "seeds/spread_seeds.hpp"

namespace iksel {
namespace {

/// From the whole database, and before it from around what the nearest is wanted to.
void search_widely(const AllSearch& parts) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  Collector& answers = parts.answers;
  lanes.refiner.begin(parts.goal.task(), kAll, Width::wide);
  if (parts.model.dof > kCurveJoints && answers.ranks_by_move() &&
      !parts.request.objective.is_set()) {
    NearbySeeds nearby(answers.nearest_to().from, parts.options.seed, parts.work);
    if (search(lanes.refiner, nearby, answers, parts.work)) return;
  }
  SpreadSeeds spread(lanes.query, parts.model.joints, parts.options.seed, answers, parts.work);
  search(lanes.refiner, spread, answers, parts.work);
  parts.work.lap(&StageTimes::iterate);
}

}  // namespace

Proof search_pose(const AllSearch& parts, RowSeeds& near, GivenSeeds& given, const Pose& Y) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  Collector& answers = parts.answers;
  if (!parts.request.database_seeds) {
    answers.converge_from_near();
    parts.run(lanes.refiner, near, given);
    return Proof::none;
  }
  if (lanes.roots) {
    const auto roots = explore_branches(parts, *lanes.roots, Proof::sweep, near, given, Y);
    if (roots.is_done) return roots.proof;
  }
  if (lanes.sweep) {
    if (const auto curve = explore_curve(parts, Y); curve.is_done) return curve.proof;
  }
  if (answers.wants_nearest() && explore_held(parts).is_done) return Proof::none;
  // Of more than seven joints it takes four times as long, and finds shorter moves for 2 to 4 of
  // 100 far ones: left as it is.
  const bool wants_nearest =
      parts.model.dof == kCurveJoints && parts.goal.is_redundant() && answers.wants_nearest();
  if (wants_nearest && !lanes.curve) answers.set_surfaces();
  answers.converge_from_near();
  if (!parts.run(lanes.refiner, near, given)) search_widely(parts);
  if (wants_nearest && !lanes.sweep && !answers.is_out_of_time()) explore_families(parts, Y);
  return Proof::none;
}

Explored explore_held(const AllSearch& parts) {
  for (Held& held : parts.workspace.lanes->held) {
    if (!held.can_hold(parts.answers.nearest_to())) continue;
    const bool found = held.find(parts.goal.target(), parts.answers.nearest_to());
    parts.work.lap(&StageTimes::query);
    if (!found) continue;
    parts.refine_rows(held.q().data(), 1, /*are_answers=*/true, Width::narrow);
    if (!parts.answers.has_any()) continue;
    parts.answers.settle(true);
    return Explored::done();
  }
  return Explored::doubtful();
}

}  // namespace iksel
