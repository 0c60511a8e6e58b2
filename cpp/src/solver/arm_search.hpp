// SPDX-License-Identifier: BSD-3-Clause
// The chains of several tips, each solved for by itself: the arms behind given values of the shared
// joints, and the chains as a whole.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/random.hpp"
#include "goal/goal.hpp"
#include "iksel/solver.hpp"
#include "iksel/structure.hpp"
#include "search/search_state.hpp"

namespace iksel {

/// Solvers of one tip.
struct TipSolvers {
  Solver chain;
  std::optional<Solver> arm;
  StructureKind of_arm = StructureKind::searched;
};

class ArmSearch {
 public:
  /// All must outlive this.
  ArmSearch(const TipsGoal& goal, const std::vector<TipSolvers>& solvers,
            const SolveRequest& request, std::uint64_t seed);

  /// Whether what collides in the scene's spheres may be an answer all the same.
  [[nodiscard]] bool may_collide() const { return may_collide_; }
  /// Whether that tip has an arm with as many joints as its task fixes axes.
  [[nodiscard]] bool has_arm(int tip) const;
  /// Whether each has.
  [[nodiscard]] bool has_all_arms() const;
  /// Whether each arm's nearest is known by the structure of the arm, wherever the others are.
  [[nodiscard]] bool knows_nearest() const;
  /// Solves for the joints of that tip's arm, the shared ones as in q; false leaves q as it is.
  /// Limits that arms share are left to what iterates all joints. With little effort nothing is
  /// asked of the answer but the task; with all, where the nearest is wanted, none need be found
  /// whose move is more than `within`.
  bool solve_arm(int tip, Effort effort, double within, JointVector& q);
  /// The joint values of that tip's arm in as many solutions, at most; those nearest to the
  /// request's `near` first, if it has one.
  std::vector<JointVector> solve_arm(int tip, const JointVector& q, int most);
  /// The same, or if there is none the joint values with the tip closest to its target; without an
  /// arm q stays as it is.
  void bring_closest(int tip, JointVector& q);
  /// Solves for all joints of that tip's chain, other tips where q puts them; from those in q first
  /// if `from_here`. What the chain's own solver says; without success q stays as it is.
  Result solve_chain(int tip, Effort effort, bool from_here, JointVector& q);

 private:
  /// What a part's solver says; q gets the part's joints, if it says any. With little effort its
  /// task and seeds are read of the request.
  static Result solve(const Solver& solver, const ChainPart& part, const Pose& target,
                      const SolveRequest& request, Effort effort, double within, JointVector& q);
  /// Whether its task bounds axes of the frame in which its target is.
  [[nodiscard]] bool is_along_frame(int tip) const;
  /// The target as the arm's base sees it.
  [[nodiscard]] Pose target_of_arm(int tip, const JointVector& q);

  const TipsGoal& goal_;
  const std::vector<TipSolvers>& solvers_;
  /// What is asked of each tip's arm.
  std::vector<SolveRequest> of_arm_;
  /// Tips whose task lies along axes of the base, which turns under the arm: one pose that the task
  /// allows is asked for after another.
  std::vector<bool> draws_pose_;
  Random random_;
  bool may_collide_;
};

}  // namespace iksel
