// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/seed_ranking.hpp"

#include "base/pseudo_inverse.hpp"
#include "base/rotation.hpp"
#include "kinematics/joint_space.hpp"
#include "refine/limited_step.hpp"

namespace iksel {

SeedRanking::SeedRanking(const RobotModel& model, const Paper& scheme, double cutoff)
    : model_(model), scheme_(scheme), cutoff_(cutoff), queue_(model.dof, scheme, kRoom) {}

void SeedRanking::rank(const Goal& goal, const std::vector<JointVector>& seeds,
                       FunctionRef<bool()> should_continue) {
  seeds_ = &seeds;
  queue_.clear(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    if (!should_continue()) return;
    queue_.push(rank_one(i, goal));
  }
  queue_.sort(seeds.size());
}

Vector6 SeedRanking::error_of(const JointVector& q, const Goal& goal, JacobianMatrix& J) const {
  const TaskSpace& task = goal.task();
  Vector6 e;
  Jacobian of_pose;
  if (!task.is_full_pose()) {
    const Pose pose = to_pose(goal.model().fk_jacobian(q.data(), of_pose));
    J = of_pose;
    e = -task.outside(task.deviation(goal.target(), pose, J));
    for (int i = 0; i < 6; ++i) {
      if (e[i] == 0) J.row(i).setZero();
    }
    return e;
  }
  const Pose tip_target = goal.tip_target();
  const Pose pose = to_pose(goal.model().fk_jacobian(q.data(), of_pose, /*with_tool=*/false));
  J = of_pose;
  e.head<3>() = tip_target.translation() - pose.translation();
  e.tail<3>() = scheme_.rotation_difference == RotationDifference::geodesic
                    ? to_rotation_vector(tip_target.linear() * pose.linear().transpose())
                    : Eigen::Vector3d(to_rotation_vector(tip_target.linear()) -
                                      to_rotation_vector(pose.linear()));
  return e;
}

Candidate SeedRanking::rank_one(std::size_t index, const Goal& goal) const {
  const JointVector& q = (*seeds_)[index];
  Candidate ranked{0, static_cast<std::uint32_t>(index), 0, false};
  if (seeds_->size() == 1) return ranked;
  if (goal.tips() != nullptr) {
    // Small beside what is missing of a pose of interest, and enough where the robot is singular.
    constexpr double kDamping = 1e-6;
    TipsGoal::Linear at;
    goal.linearize(q, /*exact=*/false, at);
    ranked.score = damped_solve(at.J, kDamping, at.missing).squaredNorm();
    return ranked;
  }
  JacobianMatrix J;
  const Vector6 e = error_of(q, goal, J);
  ranked.score = e.squaredNorm();
  if (scheme_.ranking == Ranking::nearest && !scheme_.limit_aware) return ranked;
  const JointVector adjustment = TruncatedSvd(J, cutoff_).solve(e);
  if (scheme_.ranking == Ranking::joint_adjustment) ranked.score = adjustment.squaredNorm();
  ranked.leaves_limits = scheme_.limit_aware && model_.joints.leaves(q.data(), adjustment.data());
  return ranked;
}

}  // namespace iksel
