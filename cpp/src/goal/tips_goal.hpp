// SPDX-License-Identifier: BSD-3-Clause
// What several tips have to reach at once: a task around a target for each, in the base frame or in
// that of another tip, six rows of a goal for each.
#pragma once

#include <vector>

#include "goal/linear_goal.hpp"
#include "goal/task_space.hpp"
#include "kinematics/tips_model.hpp"

namespace iksel {

class TipsGoal {
 public:
  /// A task and a target for each tip: T_base_tcp, or where `in_frame_of` is not -1, or empty,
  /// T_other_tcp, seen from the TCP of that other tip. `model` must outlive this. Throws
  /// InvalidArgumentError unless following the other tips from any of them ends at the base.
  TipsGoal(const TipsModel& model, std::vector<TaskSpace> tasks, std::vector<Pose> targets,
           std::vector<int> in_frame_of);

  [[nodiscard]] const TipsModel& model() const { return model_; }
  [[nodiscard]] int count() const { return model_.tip_count(); }
  [[nodiscard]] const TaskSpace& task(int tip) const {
    return tasks_[static_cast<std::size_t>(tip)];
  }
  [[nodiscard]] const Pose& target(int tip) const {
    return targets_[static_cast<std::size_t>(tip)];
  }
  /// The tip in whose frame that one's target is; -1: the base.
  [[nodiscard]] int frame_of(int tip) const {
    return in_frame_of_.empty() ? -1 : in_frame_of_[static_cast<std::size_t>(tip)];
  }
  /// All tips, each after the one in whose frame its target is.
  [[nodiscard]] const std::vector<int>& order() const { return order_; }
  /// Whether that tip's target is the same in the base frame wherever the joints are.
  [[nodiscard]] bool stands_still(int tip) const;
  /// That tip's target in the base frame, with the other tips where q puts them, if it moves.
  [[nodiscard]] Pose target_at(int tip, const JointVector& q) const;

  [[nodiscard]] int fixed_axes() const;
  /// The first tip whose target is farther from the base than its chain is long; -1: none.
  [[nodiscard]] int first_out_of_reach() const;
  /// The largest of all tips' errors, position [m] and rotation [rad].
  void measure(const JointVector& q, double& position, double& rotation) const;

  using Linear = LinearGoal<Eigen::Dynamic, 6 * kMaxTips>;
  /// As Goal::linearize and Goal::is_reached, of all tips.
  void linearize(const JointVector& q, bool exact, Linear& at) const;
  [[nodiscard]] bool is_reached(const Linear::Vector& missing, double part) const;

 private:
  /// T_base_tcp of a tip at q, and its Jacobian over all joints, if that is not null.
  Pose pose_of(int tip, const JointVector& q, JacobianMatrix* J = nullptr) const;
  /// As pose_of, of the pose that the tip's target is compared with, in the axes of the frame that
  /// it is seen from.
  Pose seen_pose(int tip, const JointVector& q, JacobianMatrix* J = nullptr) const;

  const TipsModel& model_;
  std::vector<TaskSpace> tasks_;
  std::vector<Pose> targets_;
  std::vector<int> in_frame_of_;
  std::vector<int> order_;
};

}  // namespace iksel
