// SPDX-License-Identifier: BSD-3-Clause
// Which tasks an arm with few joints can do.
#include <array>
#include <string>

#include "base/pseudo_inverse.hpp"
#include "goal/task_space.hpp"
#include "iksel/diagnosis.hpp"
#include "iksel/robot.hpp"

namespace iksel {
namespace {

struct NamedTask {
  const char* name;
  Task task;
};

/// Those that fix the position and as much of the rotation as may be first.
std::array<NamedTask, 10> named_tasks() {
  return {{{"free_spin('z')", Task::free_spin(Axis::z)},
           {"free_spin('x')", Task::free_spin(Axis::x)},
           {"free_spin('y')", Task::free_spin(Axis::y)},
           {"upright('z')", Task::upright(Axis::z)},
           {"upright('x')", Task::upright(Axis::x)},
           {"upright('y')", Task::upright(Axis::y)},
           {"position_only()", Task::position_only()},
           {"planar('z')", Task::planar(Axis::z)},
           {"planar('x')", Task::planar(Axis::x)},
           {"planar('y')", Task::planar(Axis::y)}}};
}

/// Whether the arm can move the TCP freely along all axes of the task at almost every
/// configuration.
bool fits(const Robot& robot, const Task& task) {
  if (robot.dof() < task.constrained_axes()) return false;
  const TaskSpace space(task, 0, 0);
  const Matrix q = robot.random_configurations(10, 1);
  for (Eigen::Index row = 0; row < q.rows(); ++row) {
    JacobianMatrix J = robot.jacobian(q.row(row));
    const Pose pose = robot.fk(q.row(row));
    space.deviation(pose, pose, J);
    for (int i = 0; i < 6; ++i) {
      if (space.lower()[i] < space.upper()[i]) J.row(i).setZero();
    }
    // Metres and radians alike, so that a small arm has no small singular values.
    J.topRows<3>() /= robot.reach();
    const auto sigma = singular_values(J);
    if ((sigma.array() > 1e-6 * sigma[0]).count() == task.constrained_axes()) return true;
  }
  return false;
}

}  // namespace

std::string task_hint(const Robot& robot, const Task& task) {
  const int axes = task.constrained_axes();
  if (robot.dof() >= axes) return "";
  std::string names;
  int last_axes = 6;
  for (const NamedTask& candidate : named_tasks()) {
    // One of each size will do.
    if (candidate.task.constrained_axes() == last_axes || !fits(robot, candidate.task)) continue;
    last_axes = candidate.task.constrained_axes();
    names += std::string(names.empty() ? "task=" : " or task=") + candidate.name;
  }
  if (names.empty()) names = "tolerances, task=box(...)";
  return "the arm has " + std::to_string(robot.dof()) + " joints, too few for the " +
         std::to_string(axes) + " axes of the task: leave axes free by " + names;
}

}  // namespace iksel
