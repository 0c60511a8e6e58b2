// SPDX-License-Identifier: BSD-3-Clause
// A first answer to a full pose, in lanes.
#include "search/explore.hpp"

namespace iksel {
namespace {

/// Of the nearest leaf, before what is known of the solutions: more cost more than that. Of 19
/// million reachable targets of swept arms none is lost (python -m bench lost --random 25 --targets
/// 50000 --seed 900 --builds srs elbow_offset wrist_offset shoulder_offset shoulder_elbow_offset).
constexpr int kFromLeaf = 4;

/// The samples of the leaf that the target falls into, best first.
class LeafSeeds {
 public:
  /// `most`: of the best of them.
  LeafSeeds(LaneQuery& query, int most, Work& work) : query_(query), most_(most), work_(work) {}

  bool next_stage() {
    work_.lap(&StageTimes::iterate);
    if (done_) return false;
    done_ = true;
    query_.prepare_leaf();
    work_.lap(&StageTimes::rank);
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (rank_ == most_ || !work_.take()) return false;
    query_.load(rank_++, refiner, lane);
    return true;
  }

 private:
  LaneQuery& query_;
  int most_;
  Work& work_;
  bool done_ = false;
  int rank_ = 0;
};

/// The nearest leaf of the database. Returns whether the answers want no more.
bool search_leaf(const FirstSearch& parts, RowSeeds& near, GivenSeeds& given) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  const bool is_quick = parts.answers.effort() == Effort::quick;
  const bool are_known = lanes.sweep || lanes.roots;
  const int from_leaf = is_quick || are_known ? kFromLeaf : lanes::kBlock;
  if (are_known) lanes.refiner.begin(parts.goal.task(), kBeforeFamilies, Width::narrow);
  LeafSeeds leaf(lanes.query, from_leaf, parts.work);
  return parts.run(lanes.refiner, near, given, leaf);
}

}  // namespace

Proof search_pose(const FirstSearch& parts, RowSeeds& near, GivenSeeds& given, const Pose& Y) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  if (search_leaf(parts, near, given)) return Proof::none;
  if (!parts.request.database_seeds || parts.answers.effort() == Effort::quick) return Proof::none;
  if (parts.goal.scene() != nullptr && lanes.sweep) {
    if (const auto free = explore_free_curve(parts, Y); free.is_done) return free.proof;
  }
  if (lanes.roots) {
    const auto roots = explore_branches(parts, *lanes.roots, Proof::sweep, near, given, Y);
    if (roots.is_done) return roots.proof;
  }
  if (lanes.sweep) {
    if (const auto any = explore_any(parts, Y); any.is_done) return any.proof;
    parts.work.leave(kBesideSolutions);
  }
  lanes.refiner.begin(parts.goal.task(), kScreened, Width::wide);
  ScreenedSeeds screened(lanes.query, lanes.screen, Y, parts.model.joints, parts.options.seed,
                         parts.work);
  search(lanes.refiner, screened, parts.answers, parts.work);
  parts.work.lap(&StageTimes::iterate);
  explore_ends(parts);
  return Proof::none;
}

Explored explore_free_curve(const FirstSearch& parts, const Pose& Y) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  if (parts.answers.is_never_free()) {
    if (!parts.answers.has_any() && !lanes.sweep->find(Y)) return Explored::doubtful();
    parts.answers.refuse();
    return Explored::done();
  }
  FreeSamples samples(*lanes.sweep, *parts.goal.scene(), Y, lanes.samples, parts.work);
  if (parts.refine(Width::narrow, samples)) return Explored::done();
  if (!samples.has_any()) return Explored::doubtful();
  parts.answers.refuse();
  return Explored::done(Proof::sweep);
}

}  // namespace iksel
