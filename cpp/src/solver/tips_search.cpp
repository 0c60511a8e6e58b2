// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tips_search.hpp"

#include <algorithm>

#include "base/low_discrepancy.hpp"
#include "search/first_answer.hpp"
#include "seeds/given_seeds.hpp"
#include "seeds/random_seeds.hpp"
#include "seeds/row_seeds.hpp"
#include "seeds/seed_sequence.hpp"
#include "solver/tips_refiner.hpp"
#include "solver/tips_seeds.hpp"

namespace iksel {
namespace {

/// Seeds that one arm has behind each value of the shared joints, of which there are others.
constexpr int kArmAttempts = 64;
/// Seeds around what the nearest is wanted to. Of 450 moves of two Pandas on a joint, 0.3 to 1
/// times the joints' ranges long, 30 were longer than by brute force without any, 15 with 64 and 8
/// with 128; brute force (200 restarts) missed 9.
constexpr int kNearbySeeds = 128;
/// Iterations of a seed while little work is done.
constexpr int kQuickIterations = 16;

}  // namespace

TipsSearch::TipsSearch(const TipsModel& model, const SolverOptions& options)
    : options_(options), steps_(low_discrepancy_steps(model.shared.size())) {
  SolverOptions of_arm = options;
  of_arm.max_attempts = std::min(options.max_attempts, kArmAttempts);
  for (const Tip& tip : model.tips) {
    TipSolvers& of_tip = solvers_.emplace_back(TipSolvers{Solver(tip.chain.robot, options), {}});
    if (!tip.arm) continue;
    if (tip.stem) {
      of_tip.arm.emplace(tip.arm->robot, of_arm);
    } else {
      of_tip.arm = of_tip.chain;
    }
  }
}

template <typename Answers>
Proof TipsSearch::search_for(Answers& answers, const Collector* collector,
                             Workspace& workspace) const {
  const Goal& goal = answers.goal();
  const SolveRequest& request = answers.request();
  Work& work = answers.work;
  if (const int tip = goal.tips()->first_out_of_reach(); tip >= 0) {
    answers.put_unreachable(tip, Status::out_of_reach);
    return Proof::reach;
  }
  ArmSearch arms(*goal.tips(), solvers_, request, options_.seed);
  TipsRefiner quick_refiner(goal, std::min(options_.max_iterations, kQuickIterations));
  TipsRefiner refiner(goal, options_.max_iterations);
  const auto should_continue = [&] { return answers.should_continue(); };
  RowSeeds near(request.near ? &*request.near : nullptr, work);
  GivenSeeds given(workspace.given, goal, request.seeds, options_.max_attempts, 1, should_continue,
                   work);
  SeedSequence given_ones(2, near, given);
  if (search(refiner, given_ones, answers, work) || !request.database_seeds) return Proof::none;
  const bool wants_nearest = collector != nullptr && collector->ranks_by_move();
  // Where the nearest is wanted, one is enough to look around.
  const auto is_enough = [&] { return wants_nearest && collector->has_any(); };
  ArmSeeds quickly_behind_shared(goal, arms, steps_, Effort::quick, collector, work);
  if (search(quick_refiner, quickly_behind_shared, answers, work)) return Proof::none;
  const auto unreachable = [&](int tip, const Result& alone) {
    answers.put_unreachable(tip, alone.status);
    return alone.proof;
  };
  ChainSeeds quickly_of_chains(*goal.tips(), arms, Effort::quick, options_.seed, work, unreachable,
                               is_enough);
  if (search(quick_refiner, quickly_of_chains, answers, work)) return Proof::none;
  ArmSeeds behind_shared(goal, arms, steps_, Effort::full, collector, work);
  if (!is_enough() && search(refiner, behind_shared, answers, work)) return Proof::none;
  ChainSeeds of_chains(*goal.tips(), arms, Effort::full, options_.seed, work, unreachable,
                       is_enough);
  if (search(refiner, of_chains, answers, work)) return Proof::none;
  if (is_enough()) {
    // Between the values of the shared joints others are nearer at times.
    NearbySeeds nearby(collector->nearest_to().from, options_.seed, work, kNearbySeeds);
    search(refiner, nearby, answers, work);
  }
  return of_chains.proof();
}

Result TipsSearch::find_first(const Goal& goal, const SolveRequest& request,
                              Workspace& workspace) const {
  FirstAnswer answers(/*wraps=*/true, goal, request, options_.max_attempts);
  return answers.result(search_for(answers, nullptr, workspace));
}

void TipsSearch::collect(Collector& collector, Workspace& workspace) const {
  collector.offer_near();
  collector.conclude(search_for(collector, &collector, workspace));
}

}  // namespace iksel
