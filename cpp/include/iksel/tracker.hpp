// SPDX-License-Identifier: BSD-3-Clause
// Poses streamed one by one, each answered within the velocity limits.
#pragma once

#include <optional>
#include <vector>

#include "iksel/export.hpp"
#include "iksel/objective.hpp"
#include "iksel/request.hpp"
#include "iksel/result.hpp"
#include "iksel/scene.hpp"
#include "iksel/solver.hpp"
#include "iksel/types.hpp"

namespace iksel {

class Goal;

/// What a Tracker remembers of the steps before.
struct TrackerState {
  /// Where the arm was when it last reached its pose, or began; none: where it is [rad or m].
  std::optional<JointVector> reached;
  JointVector velocity;          ///< of its joints in the last step [rad/s or m/s]; empty: 0
  std::vector<StoredPose> last;  ///< the last target of each tip; empty: where the tools are
  double speed = 0;         ///< of the targets when they last moved, by the weights [1/s]; 0: never
  bool is_at_edge = false;  ///< where it is nearest to a pose that cannot be reached
};

/// Follows a stream of poses: each answer continues from the last, within the velocity limits. Not
/// to be used from two threads at once; allocates nothing after construction.
class IKSEL_EXPORT Tracker {
 public:
  /// The tool is at most so many times as fast as the target, where `closest` is asked for: both
  /// are measured by its weights, and a target at rest counts as fast as it last was.
  static constexpr double kFastestTool = 3;
  /// In this time an arm would be where its objective is least, if it went on as it begins [s].
  static constexpr double kObjectiveTime = 0.5;

  /// `start` is where the arm is, as measured: it may lie outside the limits, and the way back
  /// inside is then part of the first moves. Throws InvalidArgumentError if it has not dof finite
  /// elements, or about criteria that do not fit. `closest`: what is done where a pose
  /// cannot be reached from where the arm is (track). `criteria`: what of the poses has to be
  /// reached, as of solve. `objective`: an arm that its poses leave free moves to where this is
  /// least, as fast as the poses leave it. `state`: of a tracker that goes on.
  Tracker(const Solver& solver, const JointVector& start,
          const std::optional<PoseWeights>& closest = std::nullopt,
          const TargetCriteria& criteria = {}, const Objective& objective = {},
          const TrackerState& state = {});

  /// Moves on towards the pose, by no more than each joint can in `dt` seconds; through a
  /// singularity, where solutions meet, straight on. Status `solved`: there. `too_fast`: the arm
  /// needs more time, and went as far on the straight way in joint space as it could, or as its
  /// tool may (kFastestTool). `closest`, only if that is asked for: the pose cannot be reached from
  /// here, and the arm went downhill to where it is nearest, by the weights; with the target it
  /// comes back on the side that it left from. While a target rests that takes longer than one
  /// step, each brings the arm nearer, and in the end it rests too. Any other: there is no
  /// continuation from here, and the arm stays. `move` is the length of the move in joint space. In
  /// a scene the arm also stays, with status `in_collision`, where it would collide at the end of
  /// its move; the way there is not looked at. Throws InvalidArgumentError if the pose is not
  /// rigid, dt is not above 0, or the scene is of another chain.
  [[nodiscard]] Result track(const Pose& T_base_tip, double dt, const Scene* scene = nullptr);
  /// The same of several tips, a pose for each; what is said of the tool holds for the fastest.
  [[nodiscard]] Result track(const std::vector<Pose>& T_base_tip, double dt,
                             const Scene* scene = nullptr);

  /// Where the arm is now [rad or m]; once inside the limits, always inside.
  [[nodiscard]] const JointVector& q() const { return q_; }
  /// Where the arm was when it last reached its pose, or began; from the edge of the workspace it
  /// comes back on that side [rad or m].
  [[nodiscard]] const JointVector& reached() const { return *state_.reached; }
  /// What solves.
  [[nodiscard]] const Solver& solver() const { return solver_; }
  /// What it remembers.
  [[nodiscard]] const TrackerState& state() const { return state_; }
  /// What is done at poses that cannot be reached.
  [[nodiscard]] const std::optional<PoseWeights>& closest() const { return closest_; }
  /// What of the poses has to be reached, and in which frame they are.
  [[nodiscard]] const TargetCriteria& criteria() const { return criteria_; }
  /// Towards what it moves where the poses leave the arm free.
  [[nodiscard]] const Objective& objective() const { return objective_; }

 private:
  /// Where a tip is, in the frame of its poses.
  [[nodiscard]] Pose seen(int tip, const JointVector& q) const;
  /// What moves of a tip count, without what its task leaves free.
  [[nodiscard]] Eigen::Matrix<double, 6, 1> weights_of(int tip) const;
  /// Of a target for each tip.
  [[nodiscard]] Result follow(const Pose* targets, double dt, const Scene* scene);
  [[nodiscard]] Result approach(const Goal& goal, double dt);
  /// From where the arm is to the solution that continues its way; false if there is none.
  [[nodiscard]] bool continue_to(const Goal& goal, double dt, JointVector& q, int& steps) const;
  /// How much of the way to `end`, which reaches the goal, there is time for; of a redundant arm
  /// `end` may become one to which it is more.
  [[nodiscard]] double part_of_way(const Goal& goal, double dt, JointVector& end, int& steps) const;
  /// `part` of the way to `end`, if that brings the arm nearer; else of a way downhill, from `from`
  /// or where the arm is, what is in time and does; 1, and `end` where the arm is, if none does.
  [[nodiscard]] double come_closer(const Goal& goal, const JointVector& from, double dt,
                                   double part, JointVector& end, int& steps) const;
  /// Moves `end`, where the arm can be in time, along the self-motion towards the objective.
  void improve(const Goal& goal, const JointVector& longest, double dt, JointVector& end,
               int& steps) const;
  /// How far the tools are apart at two configurations, by the weights.
  [[nodiscard]] double tool_way(const JointVector& from, const JointVector& to) const;
  /// Remembers targets, and how fast they are.
  void stream_on(const Pose* targets, double dt);
  /// How much of a move brings the tool no farther than it may go in `dt`, `part` at most.
  [[nodiscard]] double part_for_tool(const JointVector& move, double part, double dt) const;

  Solver solver_;
  JointVector q_;
  std::optional<PoseWeights> closest_;
  TargetCriteria criteria_;
  Objective objective_;
  TrackerState state_;
};

}  // namespace iksel
