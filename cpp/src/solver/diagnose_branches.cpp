// SPDX-License-Identifier: BSD-3-Clause
#include "solver/diagnose_branches.hpp"

#include <algorithm>
#include <string>

#include "base/message_text.hpp"
#include "seeds/branch_trace.hpp"
#include "solver/limit_violations.hpp"

namespace iksel {
namespace {

constexpr const char* kCertainly = "certainly no answer: ";

std::string quoted(const ChainModel& model, int joint) {
  return "'" + model.joints.name(joint) + "'";
}

JointVector joints_of(const Enumeration& branches, int lane) {
  JointVector q(branches.chain().dof);
  branches.copy_joints(lane, q.data());
  return q;
}

/// The branch that violates the limits least, of those that reach the goal by the chain's own
/// forward kinematics; empty if there is none.
JointVector find_nearest(const ChainModel& model, const Goal& goal, const Enumeration& branches) {
  JointVector nearest;
  double least = kInfinity;
  for (int lane = 0; lane < Enumeration::kMost; ++lane) {
    if (branches.pack().best[lane] < 0) continue;
    const JointVector q = joints_of(branches, lane);
    double position = 0;
    double rotation = 0;
    goal.measure(q, position, rotation);
    const double violation = worst_violation(model.joints, q);
    if (!goal.is_reached(position, rotation) || violation >= least) continue;
    least = violation;
    nearest = q;
  }
  return nearest;
}

/// Of the branches that there are not, the one that gets farthest.
MissingAngle find_missing(const Enumeration& branches) {
  MissingAngle farthest;
  for (int lane = 0; lane < Enumeration::kMost; ++lane) {
    const MissingAngle missing = find_missing_angle(branches.chain(), branches.pack(), lane);
    if (missing.found < 0) continue;
    if (missing.found > farthest.found ||
        (missing.found == farthest.found && missing.square > farthest.square)) {
      farthest = missing;
    }
  }
  return farthest;
}

/// What the elbow would have to bend for, in a sentence's part.
std::string describe_elbow(const ChainModel& model, const ClosedFormChain& chain,
                           const ElbowSpan& span) {
  const auto axis = [&](int i) { return quoted(model, chain.joints[i]); };
  std::string first = "the axis of joint " + axis(1);
  if (chain.form.closure == lanes::Closure::intersect_12) {
    first = "the point where the axes of joints " + axis(0) + " and " + axis(1) + " meet";
  }
  std::string last = "that of joint " + axis(3);
  if (chain.form.closure != lanes::Closure::three_parallel) {
    last = "the point where those of " + axis(3) + ", " + axis(4) + " and " + axis(5) + " meet";
  }
  return first + " and " + last + " would have to be " + number_text(span.needed, kShownDigits) +
         " m apart, and joint " + axis(2) + " lets them be " +
         number_text(span.least, kShownDigits) + " to " + number_text(span.most, kShownDigits) +
         " m apart";
}

}  // namespace

std::optional<BranchReasons> explain_branches(const ChainModel& model, const Goal& goal,
                                              const Pose& Y, Enumeration& branches) {
  branches.solve(Y);
  BranchReasons reasons;
  Diagnosis& out = reasons.diagnosis;
  out.branch = find_nearest(model, goal, branches);
  if (out.branch.size() > 0) {
    out.cause = Cause::joint_limits;
    set_violation(model.joints, out.branch, out);
    out.message = kCertainly +
                  std::string(
                      "each branch that reaches the target lies outside the limits; in the "
                      "nearest, ") +
                  list_violations(model, out.branch) + ": move the target, or leave an axis free";
    reasons.seeds.push_back(out.branch);
    return reasons;
  }
  const MissingAngle missing = find_missing(branches);
  if (missing.found < 0) return std::nullopt;
  const ClosedFormChain& chain = branches.chain();
  out.cause = Cause::no_branch;
  out.joint = chain.joints[missing.joint];
  std::string what = "there is no angle of joint " + quoted(model, out.joint) +
                     " from which the others could reach the target";
  if (missing.is_elbow) {
    out.beyond_reach = missing.span.gap();
    what = describe_elbow(model, chain, missing.span);
  }
  out.message = kCertainly + ("whatever the limits, " + what) + ": move the target, or turn it";
  for (int lane = 0; lane < Enumeration::kMost; ++lane) {
    const JointVector q = joints_of(branches, lane);
    if (q.allFinite()) reasons.seeds.push_back(q);
  }
  return reasons;
}

}  // namespace iksel
