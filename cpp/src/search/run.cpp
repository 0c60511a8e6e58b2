// SPDX-License-Identifier: BSD-3-Clause
#include "search/run.hpp"

#include <optional>
#include <type_traits>

#include "base/work.hpp"
#include "search/curve_search.hpp"
#include "search/first_answer.hpp"
#include "search/search.hpp"
#include "seeds/allowed_seeds.hpp"
#include "seeds/beyond_limits.hpp"
#include "seeds/given_seeds.hpp"
#include "seeds/leaf_seeds.hpp"
#include "seeds/nearby_seeds.hpp"
#include "seeds/row_seeds.hpp"
#include "seeds/screened_seeds.hpp"
#include "seeds/seed_sequence.hpp"
#include "seeds/selected_seeds.hpp"
#include "seeds/spread_seeds.hpp"

namespace iksel {
namespace {

/// More than so many have more than one joint to spare, and are not swept.
constexpr int kSweptJoints = 7;
/// Of the nearest leaf, before the roots of a sweep: more cost more than those. Where seven joints
/// are swept, all are tried: with 4, two of a million reachable targets of pr2_right_arm were lost.
constexpr int kBeforeRoots = 4;
/// The same in a scene, where each that collides costs more than a pack of samples.
constexpr int kBeforeSamples = 2;
/// Seeds after all branches, or all roots of a sweep, led nowhere: double ones, or just outside a
/// limit, or beside a singularity (python -m bench lost --targets 0 --hard 1000000).
constexpr int kBesideBranches = 48;
constexpr int kBesideRoots = 96;
/// Seeds after a sweep that came close to an answer, but did not find one; and after the ends of
/// arcs did not either (python -m bench laws shoulder_offset shoulder_elbow_offset; beside panda).
constexpr int kBesideSweep = 192;
constexpr int kBesideEnds = 16;

/// What one search works with.
template <typename Answers>
struct Search {
  const ChainModel& model;
  const SolverOptions& options;
  const Goal& goal;
  const SolveRequest& request;
  Workspace& workspace;
  Answers& answers;
  Work& work;
  StageClock& clock;

  [[nodiscard]] NearSeed near_seed() const {
    return {request.near ? &*request.near : nullptr, work};
  }
  [[nodiscard]] GivenSeeds given_seeds(int per_stage, FunctionRef<bool()> should_continue) const {
    return {workspace.given, goal, request.seeds, options.max_attempts, per_stage,
            should_continue, work};
  }
  /// From what the request gives, and then from other sources, if they are asked for. Returns
  /// whether the answers want no more.
  template <typename Refiner, typename... Others>
  bool run(Refiner& refiner, NearSeed& near, GivenSeeds& given, Others&... others) const {
    SeedSequence seeds(request.database_seeds ? 2 + sizeof...(others) : 2, near, given, others...);
    return search(refiner, seeds, answers, work);
  }

  /// One seed at a time, by a scheme. Returns whether one reached the goal outside the limits.
  bool by_scheme() const;
  /// Returns whether there certainly are no answers but those found.
  Proof in_lanes() const;
  /// The same by near, given seeds and all branches of Y; nothing if there may be answers left to
  /// search for. `kind`: the proof that branches give.
  template <typename Branches>
  std::optional<Proof> by_branches(Branches& branches, Proof kind, NearSeed& near,
                                   GivenSeeds& given, const Pose& Y) const;
  /// From solutions that lie beside limits to answers inside, as move_inside_limits() does.
  /// `joints(i)`: the i-th of them. Returns whether the answers want no more.
  template <typename Joints>
  bool move_inside(int count, const Joints& joints) const;
  /// For a first answer of seven joints: by the sweep of one, and where that leaves a doubt by the
  /// ends of the self-motion's arcs. Nothing if there may be answers left to search for.
  std::optional<Proof> by_sweep(const Pose& Y) const;
  /// By the ends of the self-motion's arcs alone.
  std::optional<Proof> by_ends() const;
  /// Whether there is an answer that leaves all that is preferred where it is; it is then found.
  bool hold_preferred() const;
  [[nodiscard]] CurveSearch<Answers> on_curve(const Pose& Y) const {
    return {model, goal, request, *workspace.lanes, answers, work, clock, Y};
  }
};

template <typename Answers>
bool Search<Answers>::by_scheme() const {
  auto& [refiner, selection, task_samples] = *workspace.one_at_a_time;
  const auto should_continue = [&] { return answers.should_continue(); };
  NearSeed near = near_seed();
  GivenSeeds given = given_seeds(1, should_continue);
  Random random(options.seed);
  refiner.begin(goal, random);
  if (goal.is_full_pose()) {
    SelectedSeeds selected(selection, goal.tip_target(), work, clock);
    run(refiner, near, given, selected);
  } else {
    task_samples.begin(answers.wants_more() ? TaskSamples::kMany : TaskSamples::kFew);
    AllowedSeeds allowed(task_samples, model.joints, goal, random, work, clock);
    run(refiner, near, given, allowed);
  }
  clock.lap(&StageTimes::iterate);
  return refiner.has_left_limits();
}

template <typename Answers>
Proof Search<Answers>::in_lanes() const {
  LaneRefiner& refiner = workspace.lanes->refiner;
  LaneQuery& query = workspace.lanes->query;
  const auto should_continue = [&] { return answers.should_continue(); };
  NearSeed near = near_seed();
  GivenSeeds given = given_seeds(lanes::kBlock, should_continue);
  refiner.begin(goal.task(), kFirst, Width::narrow);
  const Pose Y = query.reduce(goal.target());
  if (goal.is_full_pose()) {
    refiner.set_pose(Y);
  } else {
    refiner.set_task(goal.target());
  }
  Enumeration* branches = workspace.lanes->branches_of(goal.task());
  if (branches != nullptr && request.database_seeds) {
    NearSeed none(nullptr, work);
    const auto proof = by_branches(*branches, Proof::closed_form, none, given, Y);
    if (proof) return *proof;
  }
  if (!goal.is_full_pose()) {
    clock.lap(&StageTimes::query);
    Random random(options.seed);
    AllowedSeeds allowed(query, model.joints, goal, random, work, clock);
    run(refiner, near, given, allowed);
    clock.lap(&StageTimes::iterate);
    return Proof::none;
  }
  query.set_target(Y);
  clock.lap(&StageTimes::query);
  if constexpr (!std::is_same_v<Answers, Collector>) {
    const bool is_screened = goal.scene() != nullptr && workspace.lanes->sweep;
    const int from_leaf = is_screened              ? kBeforeSamples
                          : workspace.lanes->roots ? kBeforeRoots
                                                   : lanes::kBlock;
    const bool is_swept = workspace.lanes->sweep.has_value();
    if (is_swept || workspace.lanes->roots) {
      refiner.begin(goal.task(), is_swept ? kBeforeSweep : kBeforeBranches, Width::narrow);
    }
    LeafSeeds leaf(query, from_leaf, work, clock);
    if (run(refiner, near, given, leaf) || !request.database_seeds) return Proof::none;
    if (is_screened) {
      if (const auto proof = on_curve(Y).find_free()) return *proof;
    }
  }
  if (workspace.lanes->roots && request.database_seeds) {
    const auto proof = by_branches(*workspace.lanes->roots, Proof::sweep, near, given, Y);
    if (proof) return *proof;
  }
  if constexpr (std::is_same_v<Answers, Collector>) {
    bool has_asked_ends = false;
    if (workspace.lanes->sweep && request.database_seeds) {
      auto proof = on_curve(Y).collect();
      // What ranks answers otherwise has looked for none there.
      const bool has_looked =
          answers.spread() > 0 || answers.wants_nearest() || answers.wants_nearest_free();
      if (workspace.lanes->ends && has_looked && answers.status == Status::not_converged) {
        has_asked_ends = true;
        if (const auto by_ends = this->by_ends()) proof = by_ends;
      }
      if (proof) return *proof;
    }
    if (request.database_seeds && answers.wants_nearest() && hold_preferred()) return Proof::none;
    answers.converge_from_near();
    if (run(refiner, near, given) || !request.database_seeds) return Proof::none;
    refiner.begin(goal.task(), kAll, Width::wide);
    if (model.dof > kSweptJoints && answers.ranks_by_move() && !request.objective.is_set()) {
      NearbySeeds nearby(model.joints, answers.nearest_to().from, options.seed, work);
      if (search(refiner, nearby, answers, work)) return Proof::none;
    }
    SpreadSeeds spread(query, model.joints, options.seed, answers, work);
    search(refiner, spread, answers, work);
    if (workspace.lanes->ends && !has_asked_ends && !answers.has_any()) by_ends();
  } else {
    if (workspace.lanes->sweep) {
      if (const auto proof = by_sweep(Y)) return *proof;
      work.leave(workspace.lanes->ends ? kBesideEnds : kBesideSweep);
    }
    refiner.begin(goal.task(), kScreened, Width::wide);
    ScreenedSeeds screened(query, workspace.lanes->screen, Y, model.joints, options.seed, work,
                           clock);
    search(refiner, screened, answers, work);
  }
  clock.lap(&StageTimes::iterate);
  return Proof::none;
}

template <typename Answers>
template <typename Joints>
bool Search<Answers>::move_inside(int count, const Joints& joints) const {
  bool is_satisfied = false;
  for (int i = 0; i < count && !is_satisfied && answers.should_continue(); ++i) {
    work.take_on_top();
    JointVector q = Eigen::Map<const Eigen::VectorXd>(joints(i), model.dof);
    if (!move_inside_limits(model, goal, q)) continue;
    is_satisfied = answers.offer(0, q) == Verdict::stop;
  }
  clock.lap(&StageTimes::iterate);
  return is_satisfied;
}

template <typename Answers>
std::optional<Proof> Search<Answers>::by_ends() const {
  LaneRefiner& refiner = workspace.lanes->refiner;
  EndSeeds ends(*workspace.lanes->ends, goal.target(), work, clock);
  refiner.begin(goal.task(), kNearAnswer, Width::narrow);
  const bool is_satisfied = search(refiner, ends, answers, work);
  refiner.begin(goal.task(), kFirst, Width::narrow);
  clock.lap(&StageTimes::iterate);
  if (is_satisfied || answers.has_any()) return Proof::none;
  if (move_inside(ends.count(), [&](int i) { return ends.q(i); })) return Proof::none;
  if (answers.has_any()) return Proof::none;
  return ends.is_certain() ? std::optional(Proof::sweep) : std::nullopt;
}

template <typename Answers>
std::optional<Proof> Search<Answers>::by_sweep(const Pose& Y) const {
  Workspace::InLanes& lanes = *workspace.lanes;
  SweptSeeds swept(*lanes.sweep, Y, work, clock);
  if (search(lanes.refiner, swept, answers, work)) return Proof::none;
  if (lanes.ends) {
    const auto proof = by_ends();
    if (proof == Proof::none) return proof;
    if (proof) {
      // No curve of solutions crosses a limit: one inside is closed, and between two samples.
      swept.look_between(Sweep::Between::beyond_folds);
      if (search(lanes.refiner, swept, answers, work)) return Proof::none;
      swept.give_close();
      return search(lanes.refiner, swept, answers, work) ? Proof::none : proof;
    }
  }
  swept.look_between(Sweep::Between::all);
  if (search(lanes.refiner, swept, answers, work)) return Proof::none;
  const bool knows_all_ends = lanes.ends && lanes.ends->are_all();
  if (!knows_all_ends && swept.is_none()) return Proof::sweep;
  swept.give_close();
  if (search(lanes.refiner, swept, answers, work)) return Proof::none;
  return std::nullopt;
}

template <typename Answers>
bool Search<Answers>::hold_preferred() const {
  LaneRefiner& refiner = workspace.lanes->refiner;
  for (InnerArm& inner : workspace.lanes->inner_arms) {
    if (!inner.can_hold(answers.nearest_to())) continue;
    const bool found = inner.find(goal.target(), answers.nearest_to());
    clock.lap(&StageTimes::query);
    if (!found) continue;
    RowSeeds seed(inner.q().data(), 1, static_cast<std::size_t>(model.dof), /*are_answers=*/true,
                  work);
    refiner.begin(goal.task(), kNearAnswer, Width::narrow);
    search(refiner, seed, answers, work);
    refiner.begin(goal.task(), kFirst, Width::narrow);
    clock.lap(&StageTimes::iterate);
    if (!answers.has_any()) continue;
    answers.is_settled = true;
    return true;
  }
  return false;
}

template <typename Answers>
template <typename Branches>
std::optional<Proof> Search<Answers>::by_branches(Branches& branches, Proof kind, NearSeed& near,
                                                  GivenSeeds& given, const Pose& Y) const {
  LaneRefiner& refiner = workspace.lanes->refiner;
  EnumeratedSeeds enumerated(branches, Y, answers.wants_more(), work, clock);
  SeedSequence seeds(3, near, given, enumerated);
  refiner.begin(goal.task(), kNearAnswer, Width::narrow);
  answers.look_for_partners(false);
  const bool is_satisfied = search(refiner, seeds, answers, work);
  clock.lap(&StageTimes::iterate);
  if (is_satisfied) return Proof::none;
  if (branches.may_be_singular()) answers.converge_from_near();
  // Branches of which none could be refined to the tolerances prove nothing.
  if (enumerated.is_certain()) {
    if (enumerated.is_empty()) return kind;
    if (answers.has_any() && !branches.has_families()) return kind;
  } else {
    const bool is_satisfied_inside =
        !answers.has_any() && move_inside(branches.size(), [&](int i) { return branches.q(i); });
    const bool is_all = enumerated.is_certain_but_for_limits() && !branches.has_families();
    if (is_satisfied_inside || is_all) return Proof::none;
  }
  if (kind == Proof::sweep) {
    work.leave(kBesideRoots);
  } else if (enumerated.has_all() && !answers.wants_more()) {
    work.leave(kBesideBranches);
  }
  answers.look_for_partners(true);
  if (enumerated.has_all()) answers.set_all_branches_tried();
  refiner.begin(goal.task(), kFirst, Width::narrow);
  return std::nullopt;
}

}  // namespace

Result find_first(const ChainModel& model, const SolverOptions& options, const Goal& goal,
                  const SolveRequest& request, Workspace& workspace, StageTimes* times) {
  Result result;
  if (goal.is_out_of_reach()) {
    result.status = Status::out_of_reach;
    result.proof = Proof::reach;
    return result;
  }
  StageClock clock(times);
  Work work(options.max_attempts);
  const bool wraps = workspace.scheme.whole_turns;
  FirstAnswer answers(model.joints, wraps, goal, request.deadline, result);
  const Search<FirstAnswer> search{model, options, goal, request, workspace, answers, work, clock};
  if (workspace.lanes) {
    const Proof proof = search.in_lanes();
    if (!result.success()) result.proof = proof;
  } else if (search.by_scheme() && result.status == Status::not_converged) {
    result.status = Status::outside_limits;
  }
  if (result.status == Status::in_collision && answers.is_never_free()) {
    result.proof = Proof::target;
  }
  result.attempts = work.attempts;
  result.iterations = work.iterations;
  return result;
}

void collect(const ChainModel& model, const SolverOptions& options, Collector& collector,
             Workspace& workspace, StageTimes* times) {
  const Goal& goal = collector.goal();
  if (goal.is_out_of_reach()) {
    collector.status = Status::out_of_reach;
    collector.proof = Proof::reach;
    return;
  }
  StageClock clock(times);
  collector.offer_near();
  const Search<Collector> search{model,     options,   goal,           collector.request(),
                                 workspace, collector, collector.work, clock};
  if (workspace.lanes) {
    collector.proof = search.in_lanes();
  } else if (search.by_scheme() && collector.status == Status::not_converged) {
    collector.status = Status::outside_limits;
  }
}

}  // namespace iksel
