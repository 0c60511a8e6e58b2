// SPDX-License-Identifier: BSD-3-Clause
#include "search/run.hpp"

#include "search/explore.hpp"
#include "seeds/allowed_seeds.hpp"

namespace iksel {
namespace {

/// One seed at a time, by a scheme. Returns whether one reached the goal outside the limits.
template <typename Parts>
bool search_by_scheme(const Parts& parts) {
  auto& [refiner, selection, task_samples] = *parts.workspace.one_at_a_time;
  const auto should_continue = [&] { return parts.answers.should_continue(); };
  RowSeeds near = parts.near_seed();
  GivenSeeds given = parts.given_seeds(1, should_continue);
  Random random(parts.options.seed);
  refiner.begin(parts.goal, random);
  if (parts.goal.is_full_pose()) {
    SelectedSeeds selected(selection, parts.goal.tip_target(), parts.work);
    parts.run(refiner, near, given, selected);
  } else {
    task_samples.begin();
    AllowedSeeds allowed(task_samples, parts.model.joints, parts.goal, random, parts.work);
    parts.run(refiner, near, given, allowed);
  }
  parts.work.lap(&StageTimes::iterate);
  return refiner.has_left_limits();
}

/// In lanes: all branches in closed form, if there are such; else of a full pose what else is known
/// of its solutions, and of a task the database. The proof that there are no answers but those
/// found.
template <typename Parts>
Proof search_in_lanes(const Parts& parts) {
  const Goal& goal = parts.goal;
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  const auto should_continue = [&] { return parts.answers.should_continue(); };
  RowSeeds near = parts.near_seed();
  GivenSeeds given = parts.given_seeds(lanes::kBlock, should_continue);
  lanes.refiner.begin(goal.task(), kFirst, Width::narrow);
  const Pose Y = lanes.query.reduce(goal.target());
  if (goal.is_full_pose()) {
    lanes.refiner.set_pose(Y);
  } else {
    lanes.refiner.set_task(goal.target());
  }
  Enumeration* branches = lanes.branches_of(goal.task());
  if (branches != nullptr && parts.request.database_seeds) {
    RowSeeds none(nullptr, parts.work);
    const auto explored = explore_branches(parts, *branches, Proof::closed_form, none, given, Y);
    if (explored.is_done) return explored.proof;
  }
  if (goal.is_full_pose()) {
    lanes.query.set_target(Y);
    parts.work.lap(&StageTimes::query);
    return search_pose(parts, near, given, Y);
  }
  parts.work.lap(&StageTimes::query);
  Random random(parts.options.seed);
  AllowedSeeds allowed(lanes.query, parts.model.joints, goal, random, parts.work);
  parts.run(lanes.refiner, near, given, allowed);
  parts.work.lap(&StageTimes::iterate);
  return Proof::none;
}

/// The proof that there are no answers but those found.
template <typename Answers>
Proof search_for(const SolverOptions& options, Answers& answers, Workspace& workspace,
                 StageTimes* times) {
  if (answers.goal().is_out_of_reach()) {
    answers.put_unreachable(-1, Status::out_of_reach);
    return Proof::reach;
  }
  answers.work.begin_laps(times);
  const SearchParts<Answers> parts{options, workspace, answers};
  if (workspace.lanes) return search_in_lanes(parts);
  if (search_by_scheme(parts)) answers.leave_limits();
  return Proof::none;
}

}  // namespace

Result find_first(const SolverOptions& options, const Goal& goal, const SolveRequest& request,
                  Workspace& workspace, StageTimes* times, Effort effort) {
  FirstAnswer answers(workspace.scheme.whole_turns, goal, request, options.max_attempts, effort);
  return answers.result(search_for(options, answers, workspace, times));
}

void collect(const SolverOptions& options, Collector& collector, Workspace& workspace,
             StageTimes* times) {
  collector.offer_near();
  collector.conclude(search_for(options, collector, workspace, times));
}

}  // namespace iksel
