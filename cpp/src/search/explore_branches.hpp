// SPDX-License-Identifier: BSD-3-Clause
// Families that are lists: branches in closed form, roots of a sweep, ends of arcs.
#pragma once

#include "search/explore.hpp"

namespace iksel {

/// Seeds after all branches, or all roots of a sweep, led nowhere: double ones, or just outside a
/// limit, or beside a singularity (python -m bench lost --targets 0 --hard 1000000).
inline constexpr int kBesideBranches = 48;
inline constexpr int kBesideRoots = 96;

template <typename Parts>
Explored explore_branches(const Parts& parts, BranchList& branches, Proof kind, RowSeeds& near,
                          GivenSeeds& given, const Pose& Y) {
  auto& answers = parts.answers;
  EnumeratedSeeds enumerated(branches, Y, answers.wants_more(), parts.work, parts.clock);
  SeedSequence seeds(3, near, given, enumerated);
  answers.look_for_partners(false);
  if (parts.refine(seeds, Width::narrow)) return Explored::done();
  if (branches.may_be_singular()) answers.converge_from_near();
  // Branches of which none could be refined to the tolerances prove nothing.
  if (enumerated.is_certain()) {
    if (enumerated.is_empty()) return Explored::done(kind);
    if (answers.has_any() && !branches.has_families()) return Explored::done(kind);
  } else {
    const bool is_satisfied_inside =
        !answers.has_any() &&
        parts.move_inside(branches.size(), [&](int i) { return branches.q(i); });
    const bool is_all = enumerated.is_certain_but_for_limits() && !branches.has_families();
    if (is_satisfied_inside || is_all) return Explored::done();
  }
  if (kind == Proof::sweep) {
    parts.work.leave(kBesideRoots);
  } else if (enumerated.has_all() && !answers.wants_more()) {
    parts.work.leave(kBesideBranches);
  }
  answers.look_for_partners(true);
  if (enumerated.has_all()) answers.set_all_branches_tried();
  return Explored::doubtful();
}

template <typename Parts>
Explored explore_ends(const Parts& parts) {
  EndSeeds ends(*parts.workspace.lanes->ends, parts.goal.target(), parts.work, parts.clock);
  if (parts.refine(ends, Width::narrow) || parts.answers.has_any()) return Explored::done();
  const bool is_satisfied = parts.move_inside(ends.count(), [&](int i) { return ends.q(i); });
  if (is_satisfied || parts.answers.has_any()) return Explored::done();
  if (ends.is_none()) return Explored::done(Proof::closed_form);
  return ends.is_certain() ? Explored::done(Proof::sweep) : Explored::doubtful();
}

}  // namespace iksel
