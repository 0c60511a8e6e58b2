// SPDX-License-Identifier: BSD-3-Clause
// Families that are lists: branches in closed form, roots of a sweep, ends of arcs.
#pragma once

#include "search/explore.hpp"

namespace iksel {

/// Seeds after all branches, or all roots of a sweep, led nowhere: double ones, or just outside a
/// limit, or beside a singularity (python -m bench lost --targets 0 --hard 1000000).
inline constexpr int kBesideBranches = 48;
inline constexpr int kBesideRoots = 96;

template <typename Parts, typename Branches>
Explored explore_branches(const Parts& parts, Branches& branches, Proof kind, NearSeed& near,
                          GivenSeeds& given, const Pose& Y) {
  auto& answers = parts.answers;
  EnumeratedSeeds enumerated(branches, Y, answers.wants_more(), parts.work, parts.clock);
  SeedSequence seeds(3, near, given, enumerated);
  answers.look_for_partners(false);
  if (parts.refine(seeds, Width::narrow)) return Explored::done();
  if (branches.may_be_singular()) answers.converge_from_near();
  // Branches of which none could be refined to the tolerances prove nothing.
  bool is_through = false;
  if (enumerated.is_certain()) {
    is_through = enumerated.is_empty() || (answers.has_any() && !branches.has_families());
  } else {
    const bool is_satisfied_inside =
        !answers.has_any() &&
        parts.move_inside(branches.size(), [&](int i) { return branches.q(i); });
    if (is_satisfied_inside) return Explored::done();
    is_through = enumerated.is_certain_but_for_limits() && !branches.has_families();
  }
  if (parts.request.prove && !answers.has_any() && parts.workspace.lanes->proves_none(Y)) {
    return Explored::done(Proof::intervals);
  }
  if (is_through) return Explored::done(enumerated.is_certain() ? kind : Proof::none);
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
