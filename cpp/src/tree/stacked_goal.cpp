// SPDX-License-Identifier: BSD-3-Clause
#include "tree/stacked_goal.hpp"

#include <cmath>

#include "iksel/pose.hpp"

namespace iksel {

void StackedGoal::linearize(const JointVector& q, StackedVector& deviation,
                            StackedJacobian& J) const {
  deviation.resize(rows());
  J.setZero(rows(), model_.dof());
  for (int i = 0; i < model_.tip_count(); ++i) {
    const TreePart& chain = model_.tip(i).chain;
    Pose pose;
    Jacobian of_pose;
    chain.model().fk_jacobian(picked(q, chain.joints).data(), pose, of_pose);
    if (task(i).is_full_pose()) {
      // To first order near the target, as the chains' own iterations have it.
      deviation.segment<6>(6 * i) = -pose_error(target(i), pose);
    } else {
      JacobianMatrix of_deviation = of_pose;
      deviation.segment<6>(6 * i) = task(i).deviation(target(i), pose, of_deviation);
      of_pose = of_deviation;
    }
    for (std::size_t j = 0; j < chain.joints.size(); ++j) {
      J.block<6, 1>(6 * i, chain.joints[j]) = of_pose.col(static_cast<Eigen::Index>(j));
    }
  }
  for (int i = 0; i < coupled_count(); ++i) {
    const int row = 6 * model_.tip_count() + i;
    deviation[row] = coupled(i).sum(q.data());
    J.row(row) = coupled(i).c.transpose();
  }
}

bool StackedGoal::is_reached(const StackedVector& missing, double part) const {
  for (int i = 0; i < model_.tip_count(); ++i) {
    if (missing.segment<3>(6 * i).norm() > part * task(i).position_tolerance() ||
        missing.segment<3>(6 * i + 3).norm() > part * task(i).rotation_tolerance()) {
      return false;
    }
  }
  for (int i = 0; i < coupled_count(); ++i) {
    if (!(std::abs(missing[6 * model_.tip_count() + i]) < beside(i))) return false;
  }
  return true;
}

bool StackedGoal::check(const JointVector& q, TreeResult& result) const {
  if (!model_.joints.contains(q.data())) return false;
  TipVector position(model_.tip_count());
  TipVector rotation(model_.tip_count());
  for (int i = 0; i < model_.tip_count(); ++i) {
    const Goal goal = of(i);
    goal.measure(picked(q, model_.tip(i).chain.joints), position[i], rotation[i]);
    if (!goal.is_reached(position[i], rotation[i])) return false;
  }
  result.status = Status::solved;
  result.proof = Proof::answer;
  result.q = q;
  result.position_error = position;
  result.rotation_error = rotation;
  return true;
}

}  // namespace iksel
