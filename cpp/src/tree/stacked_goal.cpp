// SPDX-License-Identifier: BSD-3-Clause
#include "tree/stacked_goal.hpp"

namespace iksel {

void StackedGoal::linearize(const JointVector& q, bool exact, Linear& at) const {
  const int rows = 6 * model_.tip_count();
  at.J.setZero(rows, model_.dof());
  for (Linear::Vector* each : {&at.deviation, &at.lower, &at.upper, &at.missing}) {
    each->resize(rows);
  }
  for (int i = 0; i < model_.tip_count(); ++i) {
    const std::vector<int>& joints = model_.tip(i).chain.joints;
    Goal::Linear of_tip;
    of(i).linearize(picked(q, joints), exact, of_tip);
    at.deviation.segment<6>(6 * i) = of_tip.deviation;
    at.lower.segment<6>(6 * i) = of_tip.lower;
    at.upper.segment<6>(6 * i) = of_tip.upper;
    at.missing.segment<6>(6 * i) = of_tip.missing;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      at.J.block<6, 1>(6 * i, joints[j]) = of_tip.J.col(static_cast<Eigen::Index>(j));
    }
  }
}

bool StackedGoal::is_reached(const Linear::Vector& missing, double part) const {
  for (int i = 0; i < model_.tip_count(); ++i) {
    if (!of(i).is_reached(Vector6(missing.segment<6>(6 * i)), part)) return false;
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
