// SPDX-License-Identifier: BSD-3-Clause
// One step into the box of a task.
#pragma once

#include "goal/task_space.hpp"

namespace iksel {

/// What is missing from a deviation to the box that iterations aim at.
inline Vector6 task_error(const TaskSpace& task, const Vector6& d) {
  return d.cwiseMax(task.aim_lower()).cwiseMin(task.aim_upper()) - d;
}

/// A step that brings the deviation d (its Jacobian J, its error e) into the box, made by
/// `step(rows, asked, squared_error)`. Parts inside the box ask for nothing, unless the step would
/// take them out of it: then they are to stay at the bound.
template <typename Step>
JointVector task_step(const TaskSpace& task, const JacobianMatrix& J, const Vector6& d,
                      const Vector6& e, const Step& step) {
  const Vector6& lower = task.aim_lower();
  const Vector6& upper = task.aim_upper();
  const double squared_error = e.squaredNorm();
  Vector6 asked = e;
  JacobianMatrix rows = J;
  bool active[6];
  for (int i = 0; i < 6; ++i) {
    active[i] = e[i] != 0 || lower[i] == upper[i];
    if (!active[i]) rows.row(i).setZero();
  }
  for (int round = 0;; ++round) {
    JointVector adjustment = step(rows, asked, squared_error);
    constexpr int kRounds = 3;
    if (round == kRounds) return adjustment;
    bool changed = false;
    for (int i = 0; i < 6; ++i) {
      if (active[i]) continue;
      const double goal = d[i] + J.row(i).dot(adjustment);
      if (goal >= lower[i] && goal <= upper[i]) continue;
      active[i] = true;
      changed = true;
      rows.row(i) = J.row(i);
      asked[i] = (goal < lower[i] ? lower[i] : upper[i]) - d[i];
    }
    if (!changed) return adjustment;
  }
}

}  // namespace iksel
