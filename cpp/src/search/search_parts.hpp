// SPDX-License-Identifier: BSD-3-Clause
// What one search works with, and what all families of solutions are explored by.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "base/function_ref.hpp"
#include "base/work.hpp"
#include "refine/best_effort.hpp"
#include "refine/lane_refiner.hpp"
#include "search/context.hpp"
#include "search/search.hpp"
#include "seeds/beyond_limits.hpp"
#include "seeds/row_seeds.hpp"
#include "seeds/seed_ranking.hpp"

namespace iksel {

/// What exploring a family of solutions led to.
struct Explored {
  /// Whether the search is over: the answers want no more, or there are no others.
  bool is_done = false;
  /// That there certainly are no answers but those found.
  Proof proof = Proof::none;

  static Explored done(Proof proof = Proof::none) { return {true, proof}; }
  static Explored doubtful() { return {}; }
};

template <typename Answers>
struct SearchParts {
  const SolverOptions& options;
  Workspace& workspace;
  Answers& answers;
  const Goal& goal = answers.goal();
  const ChainModel& model = goal.model();
  const SolveRequest& request = answers.request();
  Work& work = answers.work;

  [[nodiscard]] RowSeeds near_seed() const {
    return {request.near ? &*request.near : nullptr, work};
  }
  [[nodiscard]] GivenSeeds given_seeds(std::size_t per_stage,
                                       FunctionRef<bool()> should_continue) const {
    return {workspace.given, goal, request.seeds, options.max_attempts, per_stage,
            should_continue, work};
  }

  // Each returns whether the answers want no more.

  /// From what the request gives, and then from other sources, if they are asked for.
  template <typename Refiner, typename... Others>
  bool run(Refiner& refiner, RowSeeds& near, GivenSeeds& given, Others&... others) const {
    return search_in_turn(refiner, near, given) ||
           (request.database_seeds && search_in_turn(refiner, others...));
  }
  /// In lanes, from seeds that all but are answers, one source after the other.
  template <typename... Sources>
  bool refine(Width width, Sources&... sources) const {
    LaneRefiner& refiner = workspace.lanes->refiner;
    refiner.begin(goal.task(), kNearAnswer, width);
    const bool is_satisfied = search_in_turn(refiner, sources...);
    refiner.begin(goal.task(), kFirst, Width::narrow);
    work.lap(&StageTimes::iterate);
    return is_satisfied;
  }
  /// The same of rows of joint values.
  bool refine_rows(const double* q, std::size_t count, bool are_answers, Width width) const {
    RowSeeds seeds(q, count, static_cast<std::size_t>(model.dof), are_answers, work);
    return refine(width, seeds);
  }
  /// From solutions that lie beside limits to answers inside, as move_inside_limits() does.
  /// `joints(i)`: the i-th of them. Of those that all but meet, as double roots do and arcs at an
  /// end, the first is tried.
  template <typename Joints>
  bool move_inside(int count, const Joints& joints) const {
    /// Nearer ones lead to the same [rad or m] (python -m bench lost --random 20 --off 0.7).
    constexpr double kMeet = 0.03;
    bool is_satisfied = false;
    std::vector<int>& tried = workspace.tried;
    tried.clear();
    for (int i = 0; i < count && !is_satisfied && answers.should_continue(); ++i) {
      const bool is_tried = std::any_of(tried.begin(), tried.end(), [&](int before) {
        return model.joints.are_near(joints(before), joints(i), kMeet);
      });
      if (is_tried) continue;
      tried.push_back(i);
      JointVector q = Eigen::Map<const Eigen::VectorXd>(joints(i), model.dof);
      work.take_on_top();
      if (!move_inside_limits(goal, q)) continue;
      is_satisfied = answers.offer(0, q) == Verdict::stop;
    }
    work.lap(&StageTimes::iterate);
    return is_satisfied;
  }
  /// Seeds come to rest where the errors of position and rotation are least together. Where joints
  /// do not move along all axes one may be more than its tolerance there, and not where the other
  /// is more.
  void descend_from_rest() const {
    if (answers.rest() == nullptr || !answers.should_continue()) return;
    JointVector q = *answers.rest();
    if (descend_into_tolerances(goal, q)) answers.offer(0, q);
  }

 private:
  template <typename Refiner, typename... Sources>
  bool search_in_turn(Refiner& refiner, Sources&... sources) const {
    return (search(refiner, sources, answers, work) || ...);
  }
};

}  // namespace iksel
