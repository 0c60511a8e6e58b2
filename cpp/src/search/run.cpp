// SPDX-License-Identifier: BSD-3-Clause
#include "search/run.hpp"

#include "refine/iterate.hpp"
#include "refine/single_refiner.hpp"
#include "search/explore.hpp"
#include "seeds/allowed_seeds.hpp"

namespace iksel {
namespace {

/// One seed at a time, by a scheme. Returns whether one reached the goal outside the limits.
template <typename Parts>
bool search_by_scheme(const Parts& parts) {
  auto& [kdl_tip, kdl_tcp, selection, task_samples] = *parts.workspace.one_at_a_time;
  const Goal& goal = parts.goal;
  const auto should_continue = [&] { return parts.answers.should_continue(); };
  RowSeeds near = parts.near_seed();
  GivenSeeds given = parts.given_seeds(1, should_continue);
  Random random(parts.options.seed);
  KdlChain* kdl = goal.is_full_pose() ? kdl_tip.get() : kdl_tcp.get();
  const IterationContext context{parts.model, parts.workspace.scheme, parts.options.max_iterations,
                                 goal,        goal.tip_target(),      kdl,
                                 random};
  bool left_limits = false;
  // As the reference does, also from outside the limits.
  const auto attempt = [&](JointVector& q, int& steps) {
    const Outcome outcome = iterate(context, q, steps);
    left_limits = left_limits || outcome == Outcome::outside_limits;
    return outcome == Outcome::solved;
  };
  SingleRefiner refiner(parts.model.dof, attempt);
  if (goal.is_full_pose()) {
    SelectedSeeds selected(selection, context.tip_target, parts.work);
    parts.run(refiner, near, given, selected);
  } else {
    AllowedSeeds allowed(task_samples, goal, random, parts.work);
    parts.run(refiner, near, given, allowed);
  }
  parts.work.lap(&StageTimes::iterate);
  return left_limits;
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
  lanes.refiner.set_target(Y, goal.target());
  Enumeration* branches = lanes.branches_of(goal.task());
  if (branches != nullptr && parts.request.database_seeds) {
    // What the task does not feel stays where the nearest is wanted to.
    const JointVector* near_to = parts.answers.only_nearest_to();
    branches->hold_free_joints(near_to);
    RowSeeds none(nullptr, parts.work);
    const auto explored = explore_branches(parts, *branches, Proof::closed_form, none, given, Y);
    branches->hold_free_joints(nullptr);
    parts.answers.settle(near_to != nullptr && explored.is_done && !goal.is_full_pose());
    if (explored.is_done) return explored.proof;
  }
  if (goal.is_full_pose()) {
    lanes.query.set_target(Y);
    parts.work.lap(&StageTimes::query);
    return search_pose(parts, near, given, Y);
  }
  parts.work.lap(&StageTimes::query);
  Random random(parts.options.seed);
  AllowedSeeds allowed(lanes.query, goal, random, parts.work);
  parts.run(lanes.refiner, near, given, allowed);
  parts.work.lap(&StageTimes::iterate);
  return Proof::none;
}

}  // namespace

template <typename Answers>
Proof search_for(const SolverOptions& options, Answers& answers, Workspace& workspace,
                 StageTimes* times) {
  if (answers.goal().is_out_of_reach()) {
    answers.put_unreachable(-1, Status::out_of_reach);
    return Proof::reach;
  }
  answers.work.begin_laps(times);
  const SearchParts<Answers> parts{options, workspace, answers};
  if (workspace.lanes) {
    const Proof proof = search_in_lanes(parts);
    if (proof == Proof::none && !answers.has_any()) parts.descend_from_rest();
    return proof;
  }
  if (search_by_scheme(parts)) answers.leave_limits();
  return Proof::none;
}

template Proof search_for(const SolverOptions&, FirstAnswer&, Workspace&, StageTimes*);
template Proof search_for(const SolverOptions&, Collector&, Workspace&, StageTimes*);

}  // namespace iksel
