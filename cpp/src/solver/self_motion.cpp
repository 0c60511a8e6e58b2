// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/self_motion.hpp"

#include <algorithm>
#include <string>

#include "base/message_text.hpp"
#include "base/pose_check.hpp"
#include "iksel/error.hpp"
#include "iksel/pose.hpp"
#include "iksel/structure.hpp"
#include "search/row_answers.hpp"
#include "solver/solver_impl.hpp"
#include "structure/elbow.hpp"

namespace iksel {
namespace {

/// Holds q to the limit that an arc ends at, by a joint that follows the six others, which go to
/// the goal; where that fails, q stays.
void hold_to_limit(const Goal& goal, const SelfMotionEnd& end, JointVector& q) {
  if (end.kind != ArcEnd::limit) return;
  const ChainModel& model = goal.model();
  const Limit limit = model.joints.limit(end.joint, end.coupled_limit);
  int follows = 0;
  const JointVector row = limit.row(model.dof);
  row.cwiseAbs().maxCoeff(&follows);
  const JointVector c = row / row[follows];
  JointVector held = q;
  const auto follow = [&] {
    held[follows] = 0;
    held[follows] = (limit.held_at(end.at_upper) - limit.value(held.data())) / row[follows];
    return goal.is_solution(held);
  };
  for (int step = 0; !follow(); ++step) {
    if (step == 4) return;
    Jacobian of_pose;
    const Pose pose = to_pose(model.fk_jacobian(held.data(), of_pose));
    // Without the column of the joint that follows.
    const Jacobian of_all = of_pose - of_pose.col(follows) * c.transpose();
    const int behind = model.dof - 1 - follows;
    Matrix6 J;
    J << of_all.leftCols(follows), of_all.rightCols(behind);
    const Vector6 move = J.partialPivLu().solve(pose_error(goal.target(), pose));
    if (!move.allFinite()) return;
    held.head(follows) += move.head(follows);
    held.tail(behind) += move.tail(behind);
    held = model.joints.clamp(held);
  }
  q = held;
}

/// The arc through what was refined of its points, `first` the first of them.
SelfMotionArc make_arc(const Goal& goal, const Curve::Arc& found, std::size_t first,
                       const RowAnswers& answers, const std::optional<Elbow>& elbow) {
  SelfMotionArc arc;
  arc.begin = found.begin;
  arc.end = found.end;
  for (std::size_t i = 0; i < found.q.size(); ++i) {
    const Result& answer = answers.at(first + i);
    if (!answer.success()) continue;
    JointVector q = answer.q;
    if (i == 0) hold_to_limit(goal, arc.begin, q);
    if (i + 1 == found.q.size()) hold_to_limit(goal, arc.end, q);
    if (!arc.q.empty()) {
      JointVector image = q;
      goal.joints().wrap_nearest(arc.q.back(), 0, image);
      if (goal.is_solution(image)) q = image;
    }
    arc.q.push_back(q);
  }
  const auto move = [&](const JointVector& a, const JointVector& b) {
    return goal.joints().difference(a, b).norm();
  };
  for (std::size_t i = 1; i < arc.q.size(); ++i) arc.length += move(arc.q[i - 1], arc.q[i]);
  if (arc.is_closed() && !arc.q.empty()) arc.length += move(arc.q.back(), arc.q.front());
  if (elbow) {
    for (const JointVector& q : arc.q) arc.elbow.push_back(elbow->angle(q.data()));
  }
  return arc;
}

/// Throws InvalidArgumentError unless there is a self-motion to be asked for.
void check_self_motion(const Solver::Impl& solver, double spacing) {
  const std::string who = "self_motion: robot '" + solver.robot.name() + "'";
  if (!solver.workspaces.shared().has_arcs()) {
    const Structure structure = find_structure(solver.nominal);
    throw InvalidArgumentError(
        who + " has no self-motion that could be swept (" + to_string(structure.kind) + ": " +
        structure.description +
        "); it takes seven joints, three of whose axes meet or are parallel, and "
        "of which but the first or the last may slide");
  }
  if (!solver.task.is_full_pose()) {
    throw InvalidArgumentError(who + " is asked for a task with free axes, " +
                               std::to_string(solver.task.task().constrained_axes()) +
                               " of 6 fixed; only full poses have a self-motion of one dimension");
  }
  if (!solver.workspaces.shared().in_lanes) {
    throw InvalidArgumentError(who +
                               " is solved one seed at a time, by strategy Paper or over a "
                               "database of full keys; it takes strategy Lanes and reduced keys");
  }
  if (!(spacing >= 1e-4 && spacing <= kPi)) {
    throw InvalidArgumentError("spacing: " + number_text(spacing) + " is not in [0.0001, pi]");
  }
}

}  // namespace

SelfMotion Solver::self_motion(const Pose& T_base_tip, double spacing) const {
  const Pose target = check_pose(T_base_tip);
  check_self_motion(*impl_, spacing);
  const WorkspacePool::Lease lease(impl_->workspaces);
  const ChainModel& model = impl_->model();
  SelfMotion motion;
  const Goal goal(model, impl_->task, target);
  // The arc on which it lies may be all there is, between two samples.
  const Result first = impl_->find_first(goal, impl_->nothing, lease.get(), nullptr);
  motion.status = first.status;
  motion.proof = first.proof;
  if (!first.success() && first.proof != Proof::none) return motion;
  Workspace::InLanes& lanes = *lease.get().lanes;
  const Pose Y = lanes.query.reduce(target);
  const std::vector<Curve::Arc>& arcs =
      lanes.find_arcs(goal.target(), Y, spacing, first.q.data(), first.success() ? 1 : 0);
  std::vector<Curve::Joints> points;
  for (const auto& arc : arcs) points.insert(points.end(), arc.q.begin(), arc.q.end());
  Work work(options().max_attempts);
  RowSeeds seeds(points.empty() ? nullptr : points[0].data(), points.size(), kCurveJoints,
                 /*are_answers=*/true, work);
  const RowAnswers answers = refine_rows(seeds, goal, Y, kNearAnswer, lanes.refiner, work);
  const std::optional<Elbow> elbow = Elbow::of(model);
  std::size_t row = 0;
  for (const auto& found : arcs) {
    SelfMotionArc arc = make_arc(goal, found, row, answers, elbow);
    row += found.q.size();
    if (!arc.q.empty()) motion.arcs.push_back(std::move(arc));
  }
  std::stable_sort(
      motion.arcs.begin(), motion.arcs.end(),
      [](const SelfMotionArc& a, const SelfMotionArc& b) { return a.length > b.length; });
  if (!motion.arcs.empty()) {
    motion.status = Status::solved;
    motion.proof = Proof::answer;
  }
  return motion;
}

}  // namespace iksel
