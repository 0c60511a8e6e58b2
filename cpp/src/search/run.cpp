// SPDX-License-Identifier: BSD-3-Clause
#include "search/run.hpp"

#include <limits>
#include <type_traits>

#include "base/stage_clock.hpp"
#include "search/first_answer.hpp"
#include "search/search.hpp"
#include "seeds/allowed_seeds.hpp"
#include "seeds/given_seeds.hpp"
#include "seeds/nearest_seeds.hpp"
#include "seeds/random_seeds.hpp"
#include "seeds/seed_sequence.hpp"
#include "seeds/selected_seeds.hpp"
#include "seeds/spread_seeds.hpp"

namespace iksel {
namespace {

constexpr int kMostIterations = std::numeric_limits<int>::max();
/// Where any answer will do.
constexpr Patience kFirst{8, kMostIterations};
/// Where a seed more or less does not matter: solutions arrive after 4 iterations in the mean, and
/// what is far off after 6 costs more than what it finds.
constexpr Patience kAll{6, kMostIterations, 2};

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

  [[nodiscard]] const JointVector* near() const { return request.near ? &*request.near : nullptr; }
  /// With the seeds given first, if there are any, and then those of other sources, if they are
  /// asked for.
  template <typename Refiner, typename... Others>
  void run(Refiner& refiner, GivenSeeds& given, Others&... others) const {
    const std::size_t first = request.near || !request.seeds.empty() ? 0 : 1;
    const std::size_t end = request.database_seeds ? 1 + sizeof...(others) : 1;
    SeedSequence seeds(first, end, given, others...);
    search(refiner, seeds, answers, work);
  }

  /// One seed at a time, by a scheme. Returns whether one reached the goal outside the limits.
  bool by_scheme() const;
  void in_lanes() const;
};

template <typename Answers>
bool Search<Answers>::by_scheme() const {
  auto& [refiner, selection, task_samples] = *workspace.one_at_a_time;
  const auto should_continue = [&] { return answers.should_continue(); };
  GivenSeeds given(workspace.given, goal, near(), request.seeds, options.max_attempts, 1,
                   should_continue, work);
  Random random(options.seed);
  refiner.begin(goal, random);
  if (goal.is_full_pose()) {
    SelectedSeeds selected(selection, goal.tip_target(), work, clock);
    run(refiner, given, selected);
  } else {
    task_samples.begin(answers.wants_more() ? TaskSamples::kMany : TaskSamples::kFew);
    AllowedSeeds allowed(task_samples, model.joints, goal, random, work, clock);
    run(refiner, given, allowed);
  }
  clock.lap(&StageTimes::iterate);
  return refiner.has_left_limits();
}

template <typename Answers>
void Search<Answers>::in_lanes() const {
  const auto should_continue = [&] { return answers.should_continue(); };
  auto& [refiner, query] = *workspace.lanes;
  refiner.begin(goal.task(), kFirst);
  if (goal.is_full_pose()) {
    refiner.set_pose(query.set_target(goal.target()));
  } else {
    refiner.set_task(goal.target());
  }
  clock.lap(&StageTimes::query);
  GivenSeeds given(workspace.given, goal, near(), request.seeds, options.max_attempts,
                   lanes::kBlock, should_continue, work);
  if (!goal.is_full_pose()) {
    Random random(options.seed);
    AllowedSeeds allowed(query, model.joints, goal, random, work, clock);
    run(refiner, given, allowed);
  } else if constexpr (std::is_same_v<Answers, Collector>) {
    search(refiner, given, answers, work);
    if (!request.database_seeds) return;
    refiner.begin(goal.task(), kAll);
    SpreadSeeds spread(query, model.joints, options.seed, answers, work);
    search(refiner, spread, answers, work);
  } else {
    NearestSeeds nearest(query, work, clock);
    RandomSeeds random(model.joints, options.seed, work);
    run(refiner, given, nearest, random);
  }
  clock.lap(&StageTimes::iterate);
}

}  // namespace

Result find_first(const ChainModel& model, const SolverOptions& options, const Goal& goal,
                  const SolveRequest& request, Workspace& workspace, StageTimes* times) {
  Result result;
  if (goal.is_out_of_reach()) {
    result.status = Status::out_of_reach;
    return result;
  }
  StageClock clock(times);
  Work work(options.max_attempts);
  const bool wraps = workspace.scheme.whole_turns;
  FirstAnswer answers(model.joints, wraps, goal, request.deadline, result);
  const Search<FirstAnswer> search{model, options, goal, request, workspace, answers, work, clock};
  if (workspace.lanes) {
    search.in_lanes();
  } else if (search.by_scheme() && result.status == Status::not_converged) {
    result.status = Status::outside_limits;
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
    return;
  }
  StageClock clock(times);
  const Search<Collector> search{model,     options,   goal,           collector.request(),
                                 workspace, collector, collector.work, clock};
  if (workspace.lanes) {
    search.in_lanes();
  } else if (search.by_scheme() && collector.status == Status::not_converged) {
    collector.status = Status::outside_limits;
  }
}

}  // namespace iksel
