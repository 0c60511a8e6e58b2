// SPDX-License-Identifier: BSD-3-Clause
// What one search has to reach: a task around a target, or one for each of several tips, and the
// one check of an answer. A full pose is a task like any other, whose error is measured faster.
#pragma once

#include "base/random.hpp"
#include "goal/linear_goal.hpp"
#include "goal/task_space.hpp"
#include "goal/tips_goal.hpp"
#include "iksel/result.hpp"
#include "iksel/scene.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

class Goal {
 public:
  /// All must outlive this.
  Goal(const ChainModel& model, const TaskSpace& task, const Pose& T_base_tcp,
       const Scene* scene = nullptr)
      : robot_(model), model_(model), task_(task), target_(T_base_tcp), scene_(scene) {}
  /// Of several tips.
  explicit Goal(const TipsGoal& tips, const Scene* scene = nullptr)
      : robot_(tips.model()),
        model_(tips.model().tip(0).chain.model()),
        task_(tips.task(0)),
        target_(tips.target(0)),
        scene_(scene),
        tips_(&tips) {}

  /// Of several tips, what each has to reach; null if there is one.
  [[nodiscard]] const TipsGoal* tips() const { return tips_; }
  [[nodiscard]] const RobotModel& robot() const { return robot_; }
  [[nodiscard]] const JointSpace& joints() const { return robot_.joints; }
  /// Of lengths, while joints are brought to the goal [m].
  [[nodiscard]] double unit() const { return robot_.unit; }
  /// Whether there is one tip, of which the whole pose is asked for.
  [[nodiscard]] bool is_full_pose() const { return tips_ == nullptr && task_.is_full_pose(); }

  // Of one tip.

  [[nodiscard]] const ChainModel& model() const { return model_; }
  [[nodiscard]] const TaskSpace& task() const { return task_; }
  /// T_base_tcp.
  [[nodiscard]] const Pose& target() const { return target_; }
  /// Where the tip link is then.
  [[nodiscard]] Pose tip_target() const { return target_ * Pose(model_.tcp_inverse); }
  /// The pose nearest to the target that the task allows.
  [[nodiscard]] Pose nearest_pose() const;
  /// A pose that the task allows at random: what is free from any pose in the ball that the arm can
  /// reach at all, what is within bounds from between them.
  Pose random_pose(Random& random) const;

  // Of any number of tips.

  /// Whether there are more joints than axes fixed: then solutions come in families.
  [[nodiscard]] bool is_redundant() const {
    return robot_.dof > (tips_ != nullptr ? tips_->fixed_axes() : task_.fixed_axes());
  }
  /// Whether the joints do not move the one tip along all axes: then hardly any target is reached
  /// but by what the tolerances allow, unless the task leaves the other axes free.
  [[nodiscard]] bool is_overdetermined() const {
    return tips_ == nullptr && model_.rank < kPoseJoints;
  }
  /// Whether the target, or one of them, is farther away than the links are long together, or off
  /// in what no joint moves.
  [[nodiscard]] bool is_out_of_reach() const;

  /// The errors of q, position [m] and rotation [rad], the largest of all tips; and for a full pose
  /// the Jacobian of the TCP, if that is not null.
  void measure(const JointVector& q, double& position, double& rotation,
               Jacobian* jacobian = nullptr) const;
  [[nodiscard]] bool is_reached(double position, double rotation) const {
    return position <= task_.position_tolerance() && rotation <= task_.rotation_tolerance();
  }

  using Linear = LinearGoal<6, 6>;
  /// What is wanted around q, as deviations of the TCP from the task. If not `exact`, the rotation
  /// of a full pose is to first order near the target.
  void linearize(const JointVector& q, bool exact, Linear& at) const;
  /// The same of several tips.
  void linearize(const JointVector& q, bool exact, TipsGoal::Linear& at) const {
    tips_->linearize(q, exact, at);
  }
  /// The same where the TCP is at `pose`, of which `at` has the Jacobian.
  void linearize(const Pose& pose, bool exact, Linear& at) const;
  /// Whether what is missing of a deviation is less than that part of the tolerances.
  [[nodiscard]] bool is_reached(const Vector6& missing, double part) const {
    return task_.is_reached(missing, part);
  }
  [[nodiscard]] bool is_reached(const TipsGoal::Linear::Vector& missing, double part) const {
    return tips_->is_reached(missing, part);
  }
  /// Computes the errors of q anew, whatever a search has found them to be; only if q reaches the
  /// target inside the limits, it becomes the result.
  bool check(const JointVector& q, Result& result) const;
  /// Whether such a q may be an answer: false if it collides in the scene.
  [[nodiscard]] bool is_free(const JointVector& q) const;
  /// Whether certainly none is, wherever the arm is: what moves with the tip, or is always there,
  /// touches something at the target itself. Of full poses.
  [[nodiscard]] bool is_never_free() const;
  /// What answers may not collide with; null if there is nothing.
  [[nodiscard]] const Scene* scene() const { return scene_; }
  [[nodiscard]] bool is_solution(const JointVector& q) const {
    Result measured;
    return check(q, measured);
  }

 private:
  const RobotModel& robot_;
  const ChainModel& model_;
  const TaskSpace& task_;
  const Pose& target_;
  const Scene* scene_;
  const TipsGoal* tips_ = nullptr;
};

/// Lengths of the position [m] and rotation [rad] error of a pose.
void measure_error(const Pose& target, const Frame& pose, double& position_error,
                   double& rotation_error);

}  // namespace iksel
