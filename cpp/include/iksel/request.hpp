// SPDX-License-Identifier: BSD-3-Clause
// What a caller may ask for besides the pose: near which configuration, from which seeds, which
// answers to refuse, and by when.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "iksel/export.hpp"
#include "iksel/objective.hpp"
#include "iksel/scene.hpp"
#include "iksel/task.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// How the length of a joint move is measured.
enum class MoveNorm {
  two,  ///< root of the sum of squares
  max,  ///< the largest joint's
};

/// What solve_batch does about a target that is no pose (check_pose).
enum class OnInvalidPose {
  status,  ///< Status::invalid_pose in its row; the others are solved
  raise,   ///< InvalidArgumentError that names the first, and none is solved
};

/// Tells which candidates may be answers: `q` holds `count` configurations of dof joint values, one
/// after the other, each inside the limits and at its target; sets `keep` for each. Called from the
/// thread that solves. Its exceptions end the solve and reach the caller.
using Filter = std::function<void(const double* q, std::size_t count, bool* keep)>;

/// A filter that is asked about one configuration at a time.
IKSEL_EXPORT Filter filter_each(int dof, std::function<bool(const JointVector&)> keep);

/// How far a pose is from a target: the root of the sum of the squared parts of the error, along
/// the axes of the task, each times its weight.
struct IKSEL_EXPORT PoseWeights {
  std::array<double, 3> position{1, 1, 1};  ///< [1/m]
  /// [1/rad]; empty: as the database weighs rotations, by default a quarter of the arm's reach.
  std::optional<std::array<double, 3>> rotation;

  /// Throws InvalidArgumentError unless all are finite and not below 0, and one is above.
  void validate() const;
};

/// What of a pose has to be reached, and in which frame it is given.
struct IKSEL_EXPORT TargetCriteria {
  /// What of the pose has to be reached, of several tips of each; what is not given here is as the
  /// solver's options say.
  std::optional<Task> task;
  /// Of several tips, one for each in the place of `task`. Empty: `task` holds for all.
  std::vector<Task> tasks;
  /// Of several tips, for each the number of the tip in whose frame, that of its TCP, its pose is
  /// given; -1: in the base frame, as all are if this is empty. So two hands keep what they carry
  /// between them. No tip may follow itself by way of others.
  std::vector<int> in_frame_of;

  /// Throws InvalidArgumentError naming the first field that does not fit so many tips.
  void validate(int tips) const;
};

/// What is asked of every answer, whatever it is asked for: of solve, solve_all, solve_path, ...
struct IKSEL_EXPORT AnswerCriteria : TargetCriteria {
  /// Factor on each joint's part of a move, >= 0, the largest from 1e-100 to 1e100 (so that radians
  /// and metres can be compared); empty: all 1.
  JointVector weights;
  /// How a move is measured.
  MoveNorm norm = MoveNorm::two;

  /// What answers may not collide with, as it is when the solve begins; of a robot with the same
  /// chains. The search continues within its bounds while all collide. The moves between waypoints
  /// of a path are not looked at.
  std::optional<Scene> scene;
  /// A second opinion, which is asked about what collides in the scene by its spheres: what this
  /// keeps is free. Where nothing is free by spheres, it is asked about what a search finds within
  /// its bounds. Only with a scene. Empty: the spheres decide.
  Filter exact;
  /// Refuses candidates, of those that do not collide. The search continues within its bounds while
  /// all are refused. Of a batch it is asked about the first answers of up to 256 targets at once,
  /// of a path about one waypoint's. Empty: takes all.
  Filter filter;

  /// Throws InvalidArgumentError naming the first field that does not fit `dof` joints and so many
  /// tips.
  void validate(int dof, int tips) const;
};

/// What is asked of an answer besides reaching the pose. The defaults ask for nothing.
struct IKSEL_EXPORT SolveRequest : AnswerCriteria {
  /// Joint values of any origin to iterate from [rad or m], inside the limits or not. They are
  /// ranked and iterated as the database's own, and come before those; re-selection is among the
  /// best Paper::candidates of them, and SolverOptions::max_attempts bounds how many are
  /// tried, and how many of the database's after them. Ranking n takes time n log n, ends at the
  /// deadline, and up to 1,024 need no memory.
  std::vector<JointVector> seeds;
  /// Whether other seeds follow the given ones: the database's, random ones, and those that a
  /// closed form gives (find_structure).
  bool database_seeds = true;

  /// Configuration to stay near [rad or m], typically where the arm is. May lie outside the limits,
  /// as measured joint values do. The answer is then the one with the smallest move of all that are
  /// found within the bounds on work, whole turns considered; a redundant arm's is moved along its
  /// self-motion to a local minimum of the move. Angles here, in `seeds` and the objective's
  /// posture are refused where their rounding alone could move the TCP by a tenth of the
  /// tolerances: beyond 2^53 / 10 min(rotation_tolerance, position_tolerance / reach) / (number of
  /// joints that turn), 1.5e8 rad for an arm of six joints with 1 m of reach at the default
  /// tolerances; up to 100 rad always pass.
  std::optional<JointVector> near;
  /// Wall-clock time after which no new stage of a target's search begins [s], above 0. What was
  /// found by then is judged. The one option under which the same input may give different answers.
  double deadline = std::numeric_limits<double>::infinity();

  /// What the answer is to be good at besides; comes before `near`, which then only measures the
  /// move, and chooses among periodic images that cost the same.
  Objective objective;

  /// Of solve and solve_batch: what a target without an answer gets, with Status::closest, is the
  /// configuration inside the limits that is nearest to it by these weights; of equally near ones
  /// the nearest to `near`. It is the best of the local minima that a bounded search comes to, some
  /// 100 us on top of the search for an answer, whatever the deadline. The scene and the
  /// filter refuse it too; the objective has no say. Empty: it gets nothing.
  std::optional<PoseWeights> closest;

  /// Whether a no is to be proven where that takes longer than to find it: by Proof::intervals
  /// instead of Proof::sweep, of six joints in some 20 us. Of seven, and by diagnose, it is proven
  /// anyway, where it can be.
  bool prove = false;

  /// What solve_batch does about a target that is no pose (check_pose); others always throw.
  OnInvalidPose on_invalid_pose = OnInvalidPose::status;

  /// Whether anything is asked for; weights, norm and on_invalid_pose alone ask for nothing.
  [[nodiscard]] bool has_requirements() const;
  /// Throws as AnswerCriteria::validate.
  void validate(int dof, int tips = 1) const;
};

/// In which order solve_all gives its solutions where the request has no objective.
enum class SolutionOrder {
  move,            ///< the smallest move first: from `near`, or else from the middle of the limits
  limit_distance,  ///< the largest distance from the limits first, relative to each joint's range
  manipulability,  ///< the largest sqrt(det(J J^T)) first
};

/// What solve_all gives.
struct IKSEL_EXPORT SolveAllOptions {
  /// Solutions given at most.
  int max = 64;
  /// Solutions that differ by less than this in every joint are one [rad or m]; a redundant arm's,
  /// which come in families, are spread at least this far.
  double min_distance = 0.01;
  /// Whether periodic images inside the limits count as solutions of their own. Otherwise each is
  /// given once: at the image nearest to `near`, or else to the middle of the limits.
  bool whole_turns = false;
  /// What comes first. Left at `move` where the request has an objective: solutions then come in
  /// the order of that.
  SolutionOrder order = SolutionOrder::move;

  /// Throws InvalidArgumentError naming the first option out of range.
  void validate() const;
};

/// How solve_path chooses among the solutions of each waypoint: the path with the least sum of the
/// moves is taken, by the weights and the norm; of a redundant arm one without jumps if it is
/// found, made shorter, or with more even steps where it would be too fast. The scene is not held
/// against the moves between waypoints.
struct IKSEL_EXPORT PathOptions : AnswerCriteria {
  /// Where the arm is one time step before the first waypoint [rad or m]; may lie outside the
  /// limits. Empty: the path may begin anywhere; of its periodic images, the one that begins
  /// nearest to the middle of the limits is taken.
  std::optional<JointVector> start;
  /// Time from one waypoint to the next [s]: no joint then moves farther than its velocity limit
  /// allows. 0: speeds are not limited.
  double dt = 0;
  /// Candidates kept per waypoint at most.
  int candidates = 64;
  /// Told after each waypoint; its exceptions end the search and reach the caller.
  Progress progress;

  /// Throws as AnswerCriteria::validate.
  void validate(int dof, int tips = 1) const;
};

}  // namespace iksel
