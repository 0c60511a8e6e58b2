// SPDX-License-Identifier: BSD-3-Clause
// A first answer to a full pose, in lanes.
#include "search/explore.hpp"
#include "seeds/leaf_seeds.hpp"

namespace iksel {
namespace {

/// Of the nearest leaf, before the roots of a sweep or ends in closed form: more cost more than
/// those. With little effort as many: with 2, several tips take as long. Where seven joints are
/// swept otherwise, all are tried: with 4, two of a million reachable targets of pr2_right_arm were
/// lost.
constexpr int kBeforeRoots = 4;
/// The same in a scene, where each that collides costs more than a pack of samples.
constexpr int kBeforeSamples = 2;
/// The nearest leaf of the database. Returns whether the answers want no more.
bool search_leaf(const FirstSearch& parts, bool is_screened, RowSeeds& near, GivenSeeds& given) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  const bool is_quick = parts.answers.effort() == Effort::quick;
  const bool are_known = is_quick || lanes.roots || lanes.has_closed_ends();
  const int from_leaf = is_screened ? kBeforeSamples : are_known ? kBeforeRoots : lanes::kBlock;
  if (lanes.sweep || lanes.roots) {
    lanes.refiner.begin(parts.goal.task(), lanes.sweep ? kBeforeSweep : kBeforeBranches,
                        Width::narrow);
  }
  LeafSeeds leaf(lanes.query, from_leaf, parts.work);
  return parts.run(lanes.refiner, near, given, leaf);
}

}  // namespace

Proof search_pose(const FirstSearch& parts, RowSeeds& near, GivenSeeds& given, const Pose& Y) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  const bool is_screened = parts.goal.scene() != nullptr && lanes.sweep;
  if (search_leaf(parts, is_screened, near, given)) return Proof::none;
  if (!parts.request.database_seeds || parts.answers.effort() == Effort::quick) return Proof::none;
  if (is_screened) {
    if (const auto free = explore_free_curve(parts, Y); free.is_done) return free.proof;
  }
  if (lanes.roots) {
    const auto roots = explore_branches(parts, *lanes.roots, Proof::sweep, near, given, Y);
    if (roots.is_done) return roots.proof;
  }
  if (lanes.sweep) {
    if (const auto any = explore_any(parts, Y); any.is_done) return any.proof;
    parts.work.leave(kBesideRoots);
  }
  lanes.refiner.begin(parts.goal.task(), kScreened, Width::wide);
  ScreenedSeeds screened(lanes.query, lanes.screen, Y, parts.model.joints, parts.options.seed,
                         parts.work);
  search(lanes.refiner, screened, parts.answers, parts.work);
  parts.work.lap(&StageTimes::iterate);
  return Proof::none;
}

Explored explore_free_curve(const FirstSearch& parts, const Pose& Y) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  if (parts.answers.is_never_free()) {
    if (!parts.answers.has_any() && !lanes.sweep->find(Y)) return Explored::doubtful();
    parts.answers.refuse();
    return Explored::done(Proof::target);
  }
  FreeSamples samples(*lanes.sweep, *parts.goal.scene(), Y, lanes.samples, parts.work);
  if (parts.refine(Width::narrow, samples)) return Explored::done();
  if (!samples.has_any()) return Explored::doubtful();
  parts.answers.refuse();
  return Explored::done(Proof::sweep);
}

}  // namespace iksel
