// SPDX-License-Identifier: BSD-3-Clause
// What a solve gives back.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "iksel/export.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// Why a solve ended.
enum class Status : std::uint8_t {
  solved,          ///< q reaches the target within both tolerances and lies inside the limits
  not_converged,   ///< no attempt reached the tolerances within the allowed work; Result::proof may
                   ///< say that none can
  outside_limits,  ///< attempts reached the target, but only with joints outside their limits
  out_of_reach,    ///< the target's position is farther away than the arm is long, or it is off in
                   ///< what no joint moves, as the height of a planar arm is; nothing was tried
  rejected,        ///< attempts reached the target inside the limits, but the filter refused each
  out_of_time,     ///< the deadline passed before an answer was found
  too_fast,      ///< answers exist, but joints would have to move faster than their velocity limits
  invalid_pose,  ///< the target is no pose (check_pose); in batches only, solve throws
  closest,       ///< no answer, but the configuration nearest to one (SolveRequest::closest)
  in_collision,  ///< attempts reached the target inside the limits, but each collides in the scene
};

/// Whether there are joint values with it.
constexpr bool has_joints(Status status) {
  return status == Status::solved || status == Status::closest;
}

/// Lower-case name of a status.
IKSEL_EXPORT const char* to_string(Status status);

/// What makes sure of what a result says: of one without an answer that there is none, of a set of
/// solutions that there are no others.
enum class Proof : std::uint8_t {
  none,         ///< nothing does: no answer was found by a search
  reach,        ///< the target lies farther away than the links are long together, or is off in
                ///< what no joint moves
  closed_form,  ///< all branches are known (find_structure), and no other lies inside the limits;
                ///< of seven joints, all ends of curves of solutions, and there are none inside
  intervals,  ///< each branch was enclosed by interval arithmetic over the whole range of a joint,
              ///< for every pose within the tolerances, and none lies inside the limits
  sweep,   ///< not proven: a joint was swept over its range (find_structure), and no other branch
           ///< came inside the limits at its values or beside them
  target,  ///< what the target itself places touches something in the scene: the tip, with what is
           ///< fixed to it, whatever the arm does
  answer,  ///< of what was found: it is measured on the joint values themselves. Of a set nothing
           ///< is said about others
};

/// Lower-case name of a proof.
IKSEL_EXPORT const char* to_string(Proof proof);

/// Answer to one target, or to one of each tip. Everything in it is measured on the returned q, not
/// predicted; errors are the largest of all tips.
struct Result {
  /// Why the solve ended.
  Status status = Status::not_converged;
  /// `answer` of a success; of a failure, how certain it is that there is no answer.
  Proof proof = Proof::none;
  /// Joint values [rad or m]; empty unless solved, so that no other q can be taken for an answer,
  /// or `closest`, which is given to those only who ask for it.
  JointVector q;
  /// |p_target - p(q)| [m], or what of it a task does not allow; NaN unless there is a q.
  double position_error = std::numeric_limits<double>::quiet_NaN();
  /// |rotvec(R_target R(q)^T)| [rad], or what of it a task does not allow; NaN unless there is a q.
  double rotation_error = std::numeric_limits<double>::quiet_NaN();
  /// Length of the move from `near` to q, by the request's norm and weights; NaN without a q or a
  /// `near`.
  double move = std::numeric_limits<double>::quiet_NaN();
  /// Cost of q by the request's objective; NaN unless solved with one.
  double cost = std::numeric_limits<double>::quiet_NaN();
  /// Seeds tried; of several tips, values of the joints that they share among them.
  int attempts = 0;
  /// Iteration steps over all attempts.
  int iterations = 0;
  /// Of a failure with several tips: one whose target its chain cannot reach by itself, as far as a
  /// search can tell, and status and proof are that chain's; -1: each can, or none was looked at.
  int unreachable_tip = -1;

  /// Whether q reaches the target within both tolerances and lies inside the limits.
  [[nodiscard]] bool success() const { return status == Status::solved; }
};

/// The distinct solutions for one target, best first.
struct Solutions {
  /// `solved` if there is at least one; else why there is none.
  Status status = Status::not_converged;
  /// Of an empty set, whether there is certainly no solution; of another, whether there are
  /// certainly no more (all of them were found in closed form), or `answer` if that is not known.
  Proof proof = Proof::none;
  /// Each is a success by itself; `attempts` and `iterations` are those of the whole search.
  std::vector<Result> all;
  int attempts = 0;    ///< seeds tried
  int iterations = 0;  ///< iteration steps over all attempts

  /// Whether there is at least one.
  [[nodiscard]] bool success() const { return status == Status::solved; }
};

/// Time spent in each stage of one or more solves [ns].
struct StageTimes {
  double query = 0;
  double rank = 0;
  double iterate = 0;
  double reselect = 0;
};

/// Answers to many targets as arrays; row i belongs to target i. The pointers are the caller's;
/// null for those that are not wanted of the last three.
struct BatchView {
  double* q;                 ///< joint values [rad or m], (n, dof); NaN where not solved
  std::uint8_t* status;      ///< values of Status, (n,)
  double* position_error;    ///< distances to the targets [m], (n,); NaN where not solved
  double* rotation_error;    ///< lengths of the rotation vectors to the targets [rad], (n,); NaN
                             ///< where not solved
  std::int32_t* attempts;    ///< seeds tried, (n,)
  std::int32_t* iterations;  ///< iteration steps over all attempts, (n,)
  double* move = nullptr;    ///< lengths of the moves from `near`, (n,); NaN where not solved or
                             ///< without one
  std::uint8_t* proof = nullptr;  ///< values of Proof, (n,); that of `answer` where solved
  /// Where not solved, with several tips: one whose target its chain cannot reach by itself, (n,);
  /// -1: each can, or none was looked at
  std::int32_t* unreachable_tip = nullptr;
};

}  // namespace iksel
