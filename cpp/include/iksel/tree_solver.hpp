// SPDX-License-Identifier: BSD-3-Clause
// Inverse kinematics for several tips at once.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "iksel/diagnosis.hpp"
#include "iksel/export.hpp"
#include "iksel/options.hpp"
#include "iksel/request.hpp"
#include "iksel/result.hpp"
#include "iksel/solver.hpp"
#include "iksel/tree_robot.hpp"

namespace iksel {

/// What is asked of an answer besides reaching all targets; fields as in SolveRequest.
struct IKSEL_EXPORT TreeRequest {
  /// Configuration to stay near [rad or m]. The answer is the one with the smallest move of those
  /// that a bounded search finds, each moved to where the move is locally least.
  std::optional<JointVector> near;
  JointVector weights;
  MoveNorm norm = MoveNorm::two;
  Filter filter;
  double deadline = std::numeric_limits<double>::infinity();
  /// What of each tip's pose has to be reached, one for each tip; empty: what the solver's options
  /// say, of each.
  std::vector<Task> tasks;

  /// Throws InvalidArgumentError naming the first field that does not fit so many joints and tips.
  void validate(int dof, int tips) const;
};

/// Answer to one target of each tip. Everything in it is measured on the returned q.
struct TreeResult {
  /// Of a failure: that of the tip that cannot be reached even by itself, if one is found.
  Status status = Status::not_converged;
  /// `answer` of a success; of a failure, how certain it is: that of the same tip.
  Proof proof = Proof::none;
  /// Joint values [rad or m]; empty unless solved.
  JointVector q;
  /// Errors of each tip as in Result; empty unless solved.
  TipVector position_error, rotation_error;
  /// Length of the move from `near` to q, by the request's norm and weights; NaN without either.
  double move = std::numeric_limits<double>::quiet_NaN();
  /// Of a failure, a tip whose target its chain cannot reach by itself, as far as a search can
  /// tell; -1: each can, or it was not looked for (solved, out of time, refused by a filter).
  int unreachable_tip = -1;
  /// Values of the shared joints and seeds that were tried.
  int attempts = 0;
  /// Iteration steps on all tips together; those of the chains by themselves do not count.
  int iterations = 0;

  [[nodiscard]] bool success() const { return status == Status::solved; }
};

/// Why a target has no answer.
struct TreeDiagnosis {
  /// That of each chain by itself, the others left out.
  std::vector<Diagnosis> tips;
  /// The first tip that cannot be reached by itself; -1 if each can.
  int unreachable_tip = -1;
  /// What is wrong, in a sentence.
  std::string message;
};

/// Solves for all tips of a robot at once. Immutable; copies share the data. Safe to use from many
/// threads at once, and the same input gives the same bits from any of them.
///
/// The joints that several tips share are set to a value, and behind them each arm is a chain that
/// is solved for by itself, completely where a Solver is complete (find_structure). Where that
/// leads nowhere, or an arm has too few joints of its own for its task, all joints are iterated
/// together: Levenberg-Marquardt with the limits inside the step on the errors of all tips.
class IKSEL_EXPORT TreeSolver {
 public:
  /// Builds the databases of the chains by `options.database`. The tolerances, the task and the
  /// bounds on work hold for each tip. Throws InvalidArgumentError on options out of range.
  explicit TreeSolver(const TreeRobot& robot, const SolverOptions& options = {});

  [[nodiscard]] const TreeRobot& robot() const;
  [[nodiscard]] const SolverOptions& options() const;
  /// The solver of one tip's chain by itself. Throws InvalidArgumentError if there is no such tip.
  [[nodiscard]] const Solver& chain_solver(int tip) const;

  /// Joint values that put each tip at its pose, T_base_tip in the order of the tips. Throws
  /// InvalidArgumentError if there is not one pose for each, or one is none (check_pose); poses
  /// that cannot be reached are no error but a status.
  [[nodiscard]] TreeResult solve(const std::vector<Pose>& T_base_tip,
                                 const TreeRequest& request = {}) const;

  /// Solves many targets: T_base_tip holds those of all tips at the first, at the second, ...;
  /// result i has the bits that solve() gives for the i-th, on any number of threads, but a target
  /// of which a pose is none has Status::invalid_pose. `near` is empty, or has one configuration
  /// for each target, which counts instead of the request's. `threads` = 0 takes one per core. A
  /// filter is called from any thread, one at a time. Throws InvalidArgumentError if the poses are
  /// not a whole number of targets, or as solve about the request.
  [[nodiscard]] std::vector<TreeResult> solve_batch(const std::vector<Pose>& T_base_tip,
                                                    const TreeRequest& request = {},
                                                    const std::vector<JointVector>& near = {},
                                                    int threads = 0,
                                                    const Progress& progress = {}) const;

  /// Why there is no answer: whether each tip can be reached by itself. Spends more than solving
  /// does. Throws as solve.
  [[nodiscard]] TreeDiagnosis diagnose(const std::vector<Pose>& T_base_tip,
                                       const TreeRequest& request = {}) const;

  /// What it holds; for the library's own files.
  struct Impl;

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace iksel
