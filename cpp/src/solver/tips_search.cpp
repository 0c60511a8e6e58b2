// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tips_search.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "base/low_discrepancy.hpp"
#include "refine/self_motion.hpp"
#include "refine/single_refiner.hpp"
#include "search/first_answer.hpp"
#include "search/search_parts.hpp"
#include "seeds/random_seeds.hpp"
#include "solver/tips_seeds.hpp"

namespace iksel {
namespace {

/// Seeds that one arm has behind each value of the shared joints, of which there are others.
constexpr int kArmAttempts = 64;
/// Iterations of a seed while little work is done.
constexpr int kQuickIterations = 16;

/// Whether something was found that nothing refuses, as far as is known: a filter is asked later.
bool has_passing(const Collector& found) {
  const SolveRequest& request = found.request();
  if (found.wants_nearest()) return found.has_any();
  if (request.filter || request.exact) return false;
  const auto dof = static_cast<Eigen::Index>(found.goal().joints().dof());
  for (std::size_t i = 0; i < found.count(); ++i) {
    if (found.goal().is_free(Eigen::Map<const Eigen::VectorXd>(found.solution(i), dof)))
      return true;
  }
  return false;
}

/// From a part of kNearby seeds around what the nearest is wanted to. Returns whether the answers
/// want no more.
template <typename Answers>
bool look_around(const Collector& collector, double part, std::uint64_t seed,
                 SingleRefiner& refiner, Answers& answers) {
  const JointVector& from = collector.nearest_to().from;
  const int count = static_cast<int>(std::ceil(part * kNearby));
  const std::vector<double> q = sample_around(from, seed, count);
  RowSeeds nearby(q.data(), static_cast<std::size_t>(count), static_cast<std::size_t>(from.size()),
                  /*are_answers=*/false, answers.work, &Work::take_guess);
  return search(refiner, nearby, answers, answers.work);
}

}  // namespace

TipsSearch::TipsSearch(const TipsModel& model, const SolverOptions& options)
    : options_(options), steps_(low_discrepancy_steps(model.shared.size())) {
  SolverOptions of_arm = options;
  of_arm.max_attempts = std::min(options.max_attempts, kArmAttempts);
  for (const Tip& tip : model.tips) {
    TipSolvers& of_tip = solvers_.emplace_back(TipSolvers{Solver(tip.chain.robot, options), {}});
    if (!tip.arm) continue;
    of_tip.of_arm = find_structure(tip.arm->robot).kind;
    if (tip.stem) {
      of_tip.arm.emplace(tip.arm->robot, of_arm);
    } else {
      of_tip.arm = of_tip.chain;
    }
  }
}

template <typename Answers>
Proof TipsSearch::search_for(Answers& answers, Workspace& workspace) const {
  const Goal& goal = answers.goal();
  const SolveRequest& request = answers.request();
  Work& work = answers.work;
  const Collector* collector = nullptr;
  if constexpr (std::is_same_v<Answers, Collector>) collector = &answers;
  if (const int tip = goal.tips()->first_out_of_reach(); tip >= 0) {
    answers.put_unreachable(tip, Status::out_of_reach);
    return Proof::reach;
  }
  ArmSearch arms(*goal.tips(), solvers_, request, options_.seed);
  const int most = options_.max_iterations;
  // All joints at once: the errors of all tips are rows of one goal.
  const auto attempt_in = [&](int iterations) {
    return [&goal, iterations](JointVector& q, int& steps) {
      // Each chain was solved without what it shares with others.
      if (!goal.joints().sums.empty()) q = goal.joints().clamp(q);
      return converge(goal, iterations, q, steps, /*aim=*/1, /*wraps=*/true);
    };
  };
  const auto attempt = attempt_in(most);
  SingleRefiner refiner(goal.joints().dof(), attempt);
  const auto should_continue = [&] { return answers.should_continue(); };
  const SearchParts<Answers> parts{options_, workspace, answers};
  const bool wants_nearest = collector != nullptr && collector->ranks_by_move();
  // A posture too.
  RowSeeds near = wants_nearest ? RowSeeds(&collector->nearest_to().from, work) : parts.near_seed();
  GivenSeeds given = parts.given_seeds(1, should_continue);
  if (parts.run(refiner, near, given) || !request.database_seeds) return Proof::none;
  // Where the nearest is wanted, one is enough to look around.
  const auto is_enough = [&] { return wants_nearest && has_passing(*collector); };
  const auto unreachable = [&](int tip, const Result& alone) {
    answers.put_unreachable(tip, alone.status);
    return alone.proof;
  };
  const bool knows_nearest = ArmSeeds::knows_nearest(arms, collector);
  if (knows_nearest && !SharedValues::are_dense(goal.tips()->model())) {
    const SharedValues values(goal.tips()->model(), steps_, 0, &collector->nearest_to());
    const double part = values.part(collector->least_move());
    if (look_around(*collector, part, options_.seed, refiner, answers)) return Proof::none;
  }
  Proof proof = Proof::none;
  for (const Effort effort : {Effort::quick, Effort::full}) {
    const bool is_quick = effort == Effort::quick;
    const auto at_most = attempt_in(is_quick ? std::min(most, kQuickIterations) : most);
    SingleRefiner steps(goal.joints().dof(), at_most);
    ArmSeeds behind_shared(goal, arms, steps_, effort, collector, work);
    if (is_quick || !is_enough()) {
      if (search(steps, behind_shared, answers, work)) return Proof::none;
    }
    ChainSeeds of_chains(*goal.tips(), arms, effort, options_.seed, work, unreachable, is_enough);
    if (search(steps, of_chains, answers, work)) return Proof::none;
    proof = of_chains.proof();
  }
  if (is_enough() && !knows_nearest) {
    look_around(*collector, /*part=*/1, options_.seed, refiner, answers);
  }
  return proof;
}

template Proof TipsSearch::search_for(FirstAnswer&, Workspace&) const;
template Proof TipsSearch::search_for(Collector&, Workspace&) const;

}  // namespace iksel
