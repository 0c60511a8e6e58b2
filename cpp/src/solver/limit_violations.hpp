// SPDX-License-Identifier: BSD-3-Clause
// Which limits an answer violates, and by how much.
#pragma once

#include <string>

#include "iksel/diagnosis.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

/// Of lengths and angles in messages.
inline constexpr int kShownDigits = 4;

/// How far q lies outside the limits: the joint that is farthest, or what is coupled, as far as one
/// of its joints would have to move by [rad or m].
double worst_violation(const JointSpace& joints, const JointVector& q);

/// Writes to the diagnosis which limit that is, and by how much it is violated.
void set_violation(const JointSpace& joints, const JointVector& q, Diagnosis& out);

/// "joint 'a' would have to go beyond by 0.2 rad", of a diagnosis with a violation.
std::string describe_violation(const ChainModel& model, const Diagnosis& diagnosis);

/// "joint 'a' would have to be at 3.3 rad, 0.2 rad beyond its upper limit, 'b' at ..., the sum a +
/// b at ...", of each kind the farthest first.
std::string list_violations(const ChainModel& model, const JointVector& q);

}  // namespace iksel
