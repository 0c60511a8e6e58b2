// SPDX-License-Identifier: BSD-3-Clause
// Which limits an answer violates, and by how much.
#pragma once

#include <string>

#include "iksel/diagnosis.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

/// Of lengths and angles in messages.
inline constexpr int kShownDigits = 4;

/// Writes to the diagnosis which limit q violates most, and by how much. Returns how far outside
/// the joint is, or of what is coupled how far one of its joints would have to move [rad or m].
double set_violation(const JointSpace& joints, const JointVector& q, Diagnosis& out);
/// Only the latter.
double worst_violation(const JointSpace& joints, const JointVector& q);

/// "joint 'a' would have to go beyond by 0.2 rad", of a diagnosis with a violation.
std::string describe_violation(const ChainModel& model, const Diagnosis& diagnosis);

/// "joint 'a' would have to be at 3.3 rad, 0.2 rad beyond its upper limit, 'b' at ..., the sum a +
/// b at ...", of each kind the farthest first.
std::string list_violations(const ChainModel& model, const JointVector& q);

}  // namespace iksel
