// SPDX-License-Identifier: BSD-3-Clause
// Why a pose has no answer.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "iksel/export.hpp"
#include "iksel/result.hpp"
#include "iksel/robot.hpp"
#include "iksel/scene.hpp"
#include "iksel/task.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// Why a solve gave no answer. That there is no answer is certain where Diagnosis::proof is
/// `reach`, `closed_form` or `intervals`; why, where it is one of the first two, else found by
/// search and so likely.
enum class Cause : std::uint8_t {
  none,           ///< there is an answer
  out_of_reach,   ///< the position lies beyond what the arm reaches
  orientation,    ///< the position can be reached, but not with this rotation
  joint_limits,   ///< answers exist, but all with joints outside their limits
  no_branch,      ///< no joint values reach the pose, whatever the limits: known in closed form
  rejected,       ///< answers exist, but the filter refuses each
  singular,       ///< more work finds an answer, where the arm is close to a singularity
  budget,         ///< more work finds an answer: the bounds on attempts or iterations are too low
  out_of_time,    ///< more time finds an answer: the deadline is too short
  collision,      ///< answers exist, but each collides in the scene
  shared_joints,  ///< each of several tips can be reached by itself, but not all at once
};

/// Lower-case name of a cause.
IKSEL_EXPORT const char* to_string(Cause cause);

/// What Solver::diagnose found. Numbers that do not belong to the cause are NaN.
struct Diagnosis {
  /// Why there is no answer; `none` if there is one.
  Cause cause = Cause::none;
  /// What is wrong and what to do about it, in a sentence.
  std::string message;
  /// As Result::proof of a solve with SolveRequest::prove: `answer` if there is one, else that
  /// there is none.
  Proof proof = Proof::none;
  /// Seeds that were tried to find the cause; 0 where `proof` is `closed_form`: the branches say
  /// it.
  int attempts = 0;
  /// out_of_reach: distance from the nearest position that was reached [m]. no_branch: how much too
  /// long or too short the distance is that `joint`, an elbow, would have to bend for; NaN if it is
  /// no elbow.
  double beyond_reach = std::numeric_limits<double>::quiet_NaN();
  /// orientation: least rotation error that was reached with the position held [rad].
  double rotation_gap = std::numeric_limits<double>::quiet_NaN();
  /// joint_limits: index of the joint that lies farthest outside its limits in the answer that
  /// violates them least. no_branch: of the joint of which there is no angle. -1 otherwise.
  int joint = -1;
  /// joint_limits: index of the coupled limit that lies farthest outside, if that is farther than
  /// any joint; `joint` is -1 then. -1 otherwise.
  int coupled_limit = -1;
  /// joint_limits: by how much that joint, or the sum of the coupled limit, lies outside [rad or
  /// m].
  double limit_violation = std::numeric_limits<double>::quiet_NaN();
  /// joint_limits: that answer, which reaches the target outside the limits [rad or m]. Empty:
  /// another cause.
  JointVector branch;
  /// rejected, collision: how many answers the filter or the scene refused.
  int refused = 0;
  /// collision: what touches at `q`, the answer that collides least, the deepest first; else empty.
  std::vector<Contact> contacts;
  /// Least singular value of the Jacobian at `q` [mixed units]: small where it is close to a
  /// singularity.
  double least_singular_value = std::numeric_limits<double>::quiet_NaN();

  /// Best effort inside the limits [rad or m]. NO SOLUTION unless q_is_solution, as where `cause`
  /// is none, singular, budget or out_of_time.
  JointVector q;
  /// Errors of q outside of the task's box: position [m] and rotation [rad].
  double position_error = std::numeric_limits<double>::quiet_NaN();
  double rotation_error = std::numeric_limits<double>::quiet_NaN();
  /// Whether q is an answer: within the tolerances, inside the limits, passed by the scene
  /// and the filter.
  bool q_is_solution = false;

  /// Of several tips: the first that cannot be reached by itself, whose chain the numbers are
  /// about, and q has that chain's joints; -1: each can.
  int unreachable_tip = -1;
};

/// What to ask of an arm that has fewer joints than `task` has axes, in a sentence: tasks whose
/// axes its joints can all move, by the rank of their Jacobians. Empty if it has as many.
IKSEL_EXPORT std::string task_hint(const Robot& robot, const Task& task);

}  // namespace iksel
