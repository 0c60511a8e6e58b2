// SPDX-License-Identifier: BSD-3-Clause
// How the solutions of a goal are known, by the structure of the arm: finitely many branches, in
// closed form or as roots; a curve of them, of seven joints; what is left where some joints are
// held. Each function explores one such family in lanes, for a first answer or for all that are
// wanted. Y is the target as in reduction.hpp.
#pragma once

#include "search/first_answer.hpp"
#include "search/search_parts.hpp"

namespace iksel {

using FirstSearch = SearchParts<FirstAnswer>;
using AllSearch = SearchParts<Collector>;

/// Seeds after all branches, or all roots of a sweep, led nowhere: double ones, or just outside a
/// limit, or beside a singularity; and of a sweep of a chain that is only nearly the arm's, or of
/// which an answer was refused (python -m bench lost --targets 0 --hard 1000000).
inline constexpr int kBesideSolutions = 96;

/// Near, given seeds and all branches. `kind`: the proof that branches give.
template <typename Parts>
Explored explore_branches(const Parts& parts, BranchList& branches, Proof kind, RowSeeds& near,
                          GivenSeeds& given, const Pose& Y) {
  auto& answers = parts.answers;
  EnumeratedSeeds enumerated(branches, Y, answers.wants_more(), parts.work);
  answers.look_for_partners(false);
  if (parts.refine(Width::narrow, near, given, enumerated)) return Explored::done();
  const bool has_arrived = enumerated.has_arrived();
  const bool is_satisfied_inside =
      !answers.has_any() &&
      parts.move_inside(branches.size(), [&](int i) { return branches.q(i); });
  if (is_satisfied_inside) return Explored::done();
  // Branches that could not be refined to the tolerances prove nothing.
  const bool is_empty = branches.size() == 0;
  const bool is_certain = enumerated.was_tried() && branches.is_certain();
  const bool are_known = is_certain
                             ? is_empty || (answers.has_any() && has_arrived)
                             : enumerated.was_tried() && branches.is_certain_but_for_limits();
  const bool is_through = are_known && (is_empty || !branches.has_families());
  // Of full poses, as the roots are. Where these leave a doubt, it is sooner told by intervals than
  // by seeds.
  const bool is_proof_wanted = parts.request.prove || !is_through;
  if (kind == Proof::sweep && is_proof_wanted && !answers.has_any() &&
      parts.workspace.lanes->enclosure && parts.workspace.lanes->enclosure->rules_out(Y)) {
    return Explored::done(Proof::intervals);
  }
  if (is_through) return Explored::done(is_certain ? kind : Proof::none);
  const bool has_all = enumerated.was_tried() && branches.has_all();
  if (kind == Proof::sweep || (has_all && !answers.wants_more())) {
    parts.work.leave(kBesideSolutions);
  }
  answers.look_for_partners(true);
  if (has_all) answers.set_all_branches_tried();
  return Explored::doubtful();
}

// On the self-motion of seven joints of which one can be swept.

/// For any solution: by the ends of its arcs, where these tell in closed form if there is one; at
/// the samples of the sweep, and between them. Done if that is all that is wanted, or there is
/// none.
template <typename Parts>
Explored explore_any(const Parts& parts, const Pose& Y, bool at_samples = true) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  Sweep& sweep = *lanes.sweep;
  Explored any;
  const auto is_found = [&](bool is_satisfied) {
    any.is_done = is_satisfied;
    return is_satisfied || parts.answers.has_any();
  };
  const auto refine = [&](const std::vector<double>& q, bool are_answers) {
    parts.work.lap(&StageTimes::query);
    const std::size_t count = q.size() / kCurveJoints;
    return is_found(parts.refine_rows(q.data(), count, are_answers, Width::narrow));
  };
  const auto move_inside = [&](const std::vector<double>& q) {
    const auto count = static_cast<int>(q.size() / kCurveJoints);
    return is_found(parts.move_inside(
        count, [&](int i) { return &q[static_cast<std::size_t>(i) * kCurveJoints]; }));
  };
  if (lanes.has_closed_ends()) {
    ArcEnds& ends = *lanes.ends;
    bool is_none = true;
    for (std::size_t i = 0; i < ends.places(); ++i) {
      ends.begin();
      is_none = ends.find(i, parts.goal.target()) && ends.found().empty() && is_none;
      if (ends.found().empty()) continue;
      if (refine(ends.found(), /*are_answers=*/false) || move_inside(ends.found())) return any;
    }
    if (is_none) return Explored::done(Proof::closed_form);
  }
  const bool is_answer = (at_samples && sweep.find_at_samples(Y)) || sweep.find_between(Y);
  if (refine(sweep.found(), is_answer) || is_answer || !sweep.is_nominal()) return any;
  const Proof none = sweep.proof_of_none();
  if (none == Proof::none && move_inside(sweep.found())) return any;
  return Explored::done(none);
}
/// For any, once all else has found none and nothing is proven: by the ends of its arcs.
template <typename Parts>
void explore_ends(const Parts& parts) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  const bool is_worth_it = lanes.ends && !lanes.has_closed_ends() && !parts.answers.has_any();
  if (!is_worth_it || !parts.answers.should_continue()) return;
  lanes.ends->begin();
  for (std::size_t i = 0; i < lanes.ends->size(); ++i) lanes.ends->find(i, parts.goal.target());
  const auto count = static_cast<std::size_t>(lanes.ends->count());
  parts.refine_rows(lanes.ends->found().data(), count, /*are_answers=*/false, Width::narrow);
}
/// For one that is free in the goal's scene.
Explored explore_free_curve(const FirstSearch& parts, const Pose& Y);
/// For what the Collector wants, if that can be had there: the nearest, or a spread.
Explored explore_curve(const AllSearch& parts, const Pose& Y);
/// Of more than six joints of which none can be swept, for the nearest of the families of solutions
/// that have ends or that what was found belongs to: curves of seven joints, of more dimensions
/// else.
void explore_families(const AllSearch& parts, const Pose& Y);
/// Of longer chains, while all that is preferred stays where it is.
Explored explore_held(const AllSearch& parts);

/// For a full pose: the families that the arm has, and then the database. The proof that there are
/// no answers but those found.
Proof search_pose(const FirstSearch& parts, RowSeeds& near, GivenSeeds& given, const Pose& Y);
Proof search_pose(const AllSearch& parts, RowSeeds& near, GivenSeeds& given, const Pose& Y);

}  // namespace iksel
