// SPDX-License-Identifier: BSD-3-Clause
// All answers to a full pose that are wanted, in lanes.
#include "search/explore.hpp"
#include "seeds/random_seeds.hpp"

namespace iksel {
namespace {

/// Seeds that spread over all solutions: through the database some blocks at a time, the best seed
/// of each first, then at random; and before them the partners predicted from solutions that were
/// found.
class SpreadSeeds {
 public:
  SpreadSeeds(LaneQuery& query, const JointSpace& joints, std::uint64_t seed,
              const Collector& known, Work& work)
      : query_(query), joints_(joints), known_(known), work_(work), random_(seed) {
    query.begin_blocks();
  }

  bool next_stage() {
    if (!work_.has_left()) return false;
    left_ = kBlocksAtOnce * lanes::kBlock;
    const std::size_t given = query_.blocks_given();
    at_random_ = given == query_.near_blocks();
    if (at_random_) return true;
    // One alone at first where any answer will do: it may have one.
    const std::size_t most = given == 0 && !known_.wants_more() ? 1 : kBlocksAtOnce;
    blocks_ = static_cast<int>(query_.next_blocks(std::min(most, query_.near_blocks() - given)));
    left_ = blocks_ * lanes::kBlock;
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    JointVector partner;
    if (known_.pop_partner(partner)) {
      work_.take_guess();
      refiner.load_seed(lane, partner.data());
      refiner.follow(lane);
      return true;
    }
    if (known_.is_complete() || left_ == 0 || !work_.take()) return false;
    const int at = blocks_ * lanes::kBlock - left_--;
    if (at_random_) {
      load_random(joints_, random_, refiner, lane);
    } else {
      query_.load(at / blocks_, refiner, lane, at % blocks_);
    }
    return true;
  }

 private:
  LaneQuery& query_;
  const JointSpace& joints_;
  const Collector& known_;
  Work& work_;
  Random random_;
  int blocks_ = 0;
  int left_ = 0;
  bool at_random_ = false;
};

/// From the whole database, and before it from around what the nearest is wanted to.
void search_widely(const AllSearch& parts) {
  Workspace::InLanes& lanes = *parts.workspace.lanes;
  Collector& answers = parts.answers;
  lanes.refiner.begin(parts.goal.task(), kAll, Width::wide);
  if (parts.model.dof > kCurveJoints && answers.ranks_by_move()) {
    const std::vector<double> q =
        sample_around(answers.nearest_to().from, parts.options.seed, kNearby);
    RowSeeds nearby(q.data(), kNearby, answers.nearest_to().from.size(), /*are_answers=*/false,
                    parts.work, &Work::take_guess);
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
    if (answers.spread() > 0 && !answers.wants_all() && parts.run(lanes.refiner, near, given)) {
      return Proof::none;
    }
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
  explore_ends(parts);
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
