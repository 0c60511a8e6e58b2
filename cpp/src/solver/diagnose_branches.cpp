// SPDX-License-Identifier: BSD-3-Clause
#include "solver/diagnose_branches.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/message_text.hpp"
#include "simd/branch_kernel.hpp"
#include "solver/limit_violations.hpp"

namespace iksel {
namespace {

using lanes::Closure;

/// Two points of a chain, and how far apart the joint between them lets them be [m].
struct ElbowSpan {
  double needed;
  double least, most;
  /// By how much what is needed lies outside.
  [[nodiscard]] double gap() const { return needed > most ? needed - most : least - needed; }
};

/// The first angle that a branch does not have.
struct MissingAngle {
  /// How many angles of the branch were found before; -1: it has all of them.
  int found = -1;
  /// The joint whose angle there is not, as the form counts.
  int joint = -1;
  /// The difference of squares that its subproblem takes the root of, below 0.
  double square = 0;
  /// Whether that joint is the elbow, which bends for the distance from axis 2 to axis 4 as the
  /// form counts them: where those are parallel, across them.
  bool is_elbow = false;
  ElbowSpan span{};
};

/// A quality of the kernel (branch_math.hpp) that remembers the first root of less than 0.
struct Trace {
  double error;  ///< as ClosedForm::error
  int calls = 0;
  int failed = -1;
  double square = 0;

  void divide_by_product(double /*product*/) {}
  void take_root(double at, double near, double /*root*/) {
    if (failed < 0 && at < -2 * error * near) {
      failed = calls;
      square = at;
    }
    ++calls;
  }
};

/// The joints whose angles take a root, in the kernel's order, of each closure without a held
/// joint.
constexpr int kRootJoints[][3] = {{0, 2, 4}, {2, 0, 4}, {0, 2, 4}, {2, 1, 4}, {0, 4, 2}};
static_assert(static_cast<int>(Closure::three_parallel) == 4, "the last of them");

bool bends_elbow(Closure closure) {
  return closure == Closure::parallel_23 || closure == Closure::intersect_12 ||
         closure == Closure::three_parallel;
}

/// What the elbow was asked for, from the angle nearest to it that the kernel gave.
ElbowSpan span_of(const ClosedFormChain& chain, const lanes::Angle<double>& q3, double square) {
  const lanes::ClosedForm& form = chain.form;
  const lanes::Turned& elbow = form.elbow;
  const bool parallel = form.closure != Closure::intersect_12;
  const double turns_back = form.closure == Closure::three_parallel ? form.side3 : 1.0;
  const double side = elbow.a * q3.c + elbow.b * turns_back * q3.s < 0 ? -1 : 1;
  const double off = side * std::sqrt(std::max(elbow.r2 - square, 0.0));
  const double radius = std::sqrt(elbow.r2);
  // What lies along parallel axes is always there and counts for nothing.
  const lanes::Vec<double> way =
      lanes::constant<double>(form.p[1]) + lanes::constant<double>(form.p[2]);
  const double along = parallel ? dot(lanes::constant<double>(form.h[1]), way) : 0;
  const auto distance = [&](double dot) {
    const double square_of_it = form.arm2 + 2 * (elbow.c + dot) - along * along;
    return chain.unit * std::sqrt(std::max(square_of_it, 0.0));
  };
  return {distance(off), distance(-radius), distance(radius)};
}

/// Of the branch in a lane of a pack that has its target and signs. Forms without a held joint.
MissingAngle find_missing_angle(const ClosedFormChain& chain, const lanes::BranchPack& pack,
                                int lane) {
  const lanes::ClosedForm& form = chain.form;
  const auto target = lanes::load_target<double>(pack, lane);
  const lanes::Signs<double> sign(pack, lane);
  lanes::Branch<double, Trace> branch;
  branch.quality = Trace{form.error};
  if (form.closure == Closure::three_parallel) {
    lanes::solve_three_parallel(form, target, sign.of, branch);
  } else {
    lanes::place_wrist(form, target.w, sign.of, branch);
    lanes::turn_wrist(form, lanes::behind_arm(form, target, branch), sign.of[2], branch);
  }
  const Trace& trace = branch.quality;
  if (trace.failed < 0) return {};
  MissingAngle missing;
  missing.found = trace.failed;
  missing.joint = kRootJoints[static_cast<int>(form.closure)][trace.failed];
  missing.square = trace.square;
  missing.is_elbow = missing.joint == 2 && bends_elbow(form.closure);
  if (missing.is_elbow) missing.span = span_of(chain, branch.q[2], trace.square);
  return missing;
}

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
JointVector find_nearest(const Goal& goal, const Enumeration& branches) {
  JointVector nearest;
  double least = kInfinity;
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    if (branches.pack().best[lane] < 0) continue;
    const JointVector q = joints_of(branches, lane);
    double position = 0;
    double rotation = 0;
    goal.measure(q, position, rotation);
    const double violation = worst_violation(goal.joints(), q);
    if (!goal.is_reached(position, rotation) || violation >= least) continue;
    least = violation;
    nearest = q;
  }
  return nearest;
}

/// Of the branches that there are not, the one that gets farthest.
MissingAngle find_missing(const Enumeration& branches) {
  MissingAngle farthest;
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
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

bool explain_branches(const Goal& goal, const Pose& Y, Enumeration& branches, BestEffort& effort,
                      Diagnosis& out) {
  const ChainModel& model = goal.model();
  branches.solve(Y);
  out.branch = find_nearest(goal, branches);
  if (out.branch.size() > 0) {
    out.cause = Cause::joint_limits;
    set_violation(model.joints, out.branch, out);
    out.message = kCertainly +
                  std::string(
                      "each branch that reaches the target lies outside the limits; in the "
                      "nearest, ") +
                  list_violations(model, out.branch) + ": move the target, or leave an axis free";
    effort.from(out.branch);
    return true;
  }
  const MissingAngle missing = find_missing(branches);
  if (missing.found < 0) return false;
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
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    const JointVector q = joints_of(branches, lane);
    if (q.allFinite()) effort.from(q);
  }
  return true;
}

}  // namespace iksel
