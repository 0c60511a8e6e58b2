// SPDX-License-Identifier: BSD-3-Clause
#include "goal/tips_goal.hpp"

#include <algorithm>
#include <utility>

#include "base/message_text.hpp"
#include "goal/goal.hpp"
#include "iksel/error.hpp"

namespace iksel {

TipsGoal::TipsGoal(const TipsModel& model, std::vector<TaskSpace> tasks, std::vector<Pose> targets,
                   std::vector<int> in_frame_of)
    : model_(model),
      tasks_(std::move(tasks)),
      targets_(std::move(targets)),
      in_frame_of_(std::move(in_frame_of)) {
  const auto is_in = [&](int tip) {
    return tip < 0 || std::find(order_.begin(), order_.end(), tip) != order_.end();
  };
  for (int round = 0; round < count(); ++round) {
    for (int tip = 0; tip < count(); ++tip) {
      if (!is_in(tip) && is_in(frame_of(tip))) order_.push_back(tip);
    }
  }
  for (int tip = 0; tip < count(); ++tip) {
    if (is_in(tip)) continue;
    throw_invalid("in_frame_of", tip,
                  "the target of '" + model.tip_links[static_cast<std::size_t>(tip)] +
                      "' is in the frame of a tip whose own is, by way of others, in that of '" +
                      model.tip_links[static_cast<std::size_t>(tip)] +
                      "' again; one of them has to be in the base frame");
  }
}

bool TipsGoal::stands_still(int tip) const {
  const int frame = frame_of(tip);
  return frame < 0 || (task(frame).is_full_pose() && stands_still(frame));
}

Pose TipsGoal::target_at(int tip, const JointVector& q) const {
  const int frame = frame_of(tip);
  if (frame < 0) return target(tip);
  return (stands_still(tip) ? target_at(frame, q) : pose_of(frame, q)) * target(tip);
}

int TipsGoal::fixed_axes() const {
  int sum = 0;
  for (const TaskSpace& task : tasks_) sum += task.fixed_axes();
  return sum;
}

int TipsGoal::first_out_of_reach() const {
  for (int i = 0; i < count(); ++i) {
    const Goal goal(model_.tip(i).chain.model(), task(i), target(i));
    if (frame_of(i) < 0 && goal.is_out_of_reach()) return i;
  }
  return -1;
}

Pose TipsGoal::pose_of(int tip, const JointVector& q, JacobianMatrix* J) const {
  const ChainPart& chain = model_.tip(tip).chain;
  if (J == nullptr) return chain.fk(q);
  Jacobian of_chain;
  Pose pose = to_pose(chain.model().fk_jacobian(picked(q, chain.joints).data(), of_chain));
  J->setZero(6, model_.dof);
  put_columns(of_chain, chain.joints, *J);
  return pose;
}

Pose TipsGoal::seen_pose(int tip, const JointVector& q, JacobianMatrix* J) const {
  Pose pose = pose_of(tip, q, J);
  const int frame = frame_of(tip);
  if (frame < 0) return pose;
  JacobianMatrix of_frame;
  const Pose from = pose_of(frame, q, J != nullptr ? &of_frame : nullptr);
  if (J == nullptr) return from.inverse() * pose;
  // What the other tip's twists do to this one's place as seen from there; then in its axes.
  const Eigen::Vector3d lever = pose.translation() - from.translation();
  for (Eigen::Index j = 0; j < J->cols(); ++j) {
    of_frame.col(j).head<3>() += of_frame.col(j).tail<3>().cross(lever);
  }
  *J -= of_frame;
  const Eigen::Matrix3d to_frame = from.linear().transpose();
  J->topRows<3>() = to_frame * J->topRows<3>();
  J->bottomRows<3>() = to_frame * J->bottomRows<3>();
  return from.inverse() * pose;
}

void TipsGoal::measure(const JointVector& q, double& position, double& rotation) const {
  position = 0;
  rotation = 0;
  for (int i = 0; i < count(); ++i) {
    double of_position = 0;
    double of_rotation = 0;
    task(i).measure(target(i), seen_pose(i, q), of_position, of_rotation);
    // The comparison is false with NaN, which is the largest of all.
    if (!(of_position <= position)) position = of_position;
    if (!(of_rotation <= rotation)) rotation = of_rotation;
  }
}

void TipsGoal::linearize(const JointVector& q, bool exact, Linear& at) const {
  const int rows = 6 * count();
  at.J.resize(rows, model_.dof);
  for (Linear::Vector* each : {&at.deviation, &at.lower, &at.upper, &at.missing}) {
    each->resize(rows);
  }
  for (int i = 0; i < count(); ++i) {
    Goal::Linear of_tip;
    JacobianMatrix J;
    const Pose pose = seen_pose(i, q, &J);
    of_tip.J = J;
    Goal(model_.tip(i).chain.model(), task(i), target(i)).linearize(pose, exact, of_tip);
    at.J.middleRows<6>(6 * i) = of_tip.J;
    at.deviation.segment<6>(6 * i) = of_tip.deviation;
    at.lower.segment<6>(6 * i) = of_tip.lower;
    at.upper.segment<6>(6 * i) = of_tip.upper;
    at.missing.segment<6>(6 * i) = of_tip.missing;
  }
}

bool TipsGoal::is_reached(const Linear::Vector& missing, double part) const {
  for (int i = 0; i < count(); ++i) {
    if (!task(i).is_reached(Vector6(missing.segment<6>(6 * i)), part)) return false;
  }
  return true;
}

}  // namespace iksel
