// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "angle_warning.hpp"
#include "array_checks.hpp"
#include "bindings.hpp"
#include "gil.hpp"
#include "iksel/tree_solver.hpp"
#include "option_fields.hpp"
#include "pose_arguments.hpp"
#include "progress.hpp"
#include "property.hpp"
#include "py_tree.hpp"
#include "tree_keywords.hpp"

namespace iksel::python {

template <>
struct IsBoundClass<TreeRobot> : std::true_type {
  static constexpr const char* kExpected =
      "a TreeRobot, which TreeRobot.from_urdf(path_or_xml, tip_links) makes";
};

namespace {

/// What a position alone stands for, if it is the same task for all tips; else null.
const Task* common_task(const TreeSolver& self, const TreeRequest& request) {
  if (request.tasks.empty()) return &self.options().task;
  for (const Task& task : request.tasks) {
    if (task != request.tasks.front()) return nullptr;
  }
  return &request.tasks.front();
}

std::vector<Pose> as_targets(const DoubleArray& array) {
  std::vector<Pose> poses(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].matrix() = Eigen::Map<const RowMajorPose>(array.data() + 16 * i);
  }
  return poses;
}

/// One pose for each tip.
std::vector<Pose> as_tip_poses(const TreeSolver& self, const PoseLike& poses,
                               const TreeRequest& request) {
  if (is_doubles(poses)) {
    const auto array = py::reinterpret_borrow<DoubleArray>(poses);
    const int tips = self.robot().tips();
    if (array.ndim() == 4 || (array.ndim() == 2 && array.shape(1) == 4)) {
      throw_wrong_shape("poses", "one pose for each tip, (" + std::to_string(tips) + ", 4, 4)",
                        array, "; solve_batch() takes (N, k, 4, 4)");
    }
  }
  return as_targets(as_poses(poses, "poses", common_task(self, request)));
}

JointVector as_tree_near(const TreeSolver& self, const ArrayLike& near) {
  return as_joints(near, self.robot().dof(), "near");
}

TreeResult solve_tree(const TreeSolver& self, const PoseLike& poses,
                      const std::optional<ArrayLike>& near, const TreeKeywords& given) {
  TreeRequest request = read_tree_request(self, given);
  if (near) request.near = as_tree_near(self, *near);
  const std::vector<Pose> targets = as_tip_poses(self, poses, request);
  return without_gil([&] { return self.solve(targets, request); });
}

/// (N, k, 4, 4) as N k poses one after the other.
DoubleArray flatten(const PoseLike& poses, int tips) {
  const DoubleArray array = as_doubles(poses, "poses");
  if (array.ndim() != 4 || array.shape(1) != tips || array.shape(2) != 4 || array.shape(3) != 4) {
    throw_wrong_shape("poses", "an (N, " + std::to_string(tips) + ", 4, 4) array", array);
  }
  const std::vector<py::ssize_t> shape = {array.shape(0) * tips, 4, 4};
  return py::array(array).reshape(shape);
}

PyTreeBatch solve_tree_batch(const TreeSolver& self, const PoseLike& poses,
                             const std::optional<ArrayLike>& near, int threads,
                             const TreeKeywords& given) {
  TreeRequest request = read_tree_request(self, given);
  const std::vector<Pose> targets = as_targets(flatten(poses, self.robot().tips()));
  std::vector<JointVector> nears;
  if (near) {
    const DoubleArray rows = as_joint_rows(*near, self.robot().dof(), "near");
    if (rows.ndim() == 1) {
      request.near = as_tree_near(self, *near);
    } else {
      for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
        check_row(rows.data(i), i, self.robot().dof(), "near");
        nears.emplace_back(Eigen::Map<const Eigen::VectorXd>(rows.data(i), self.robot().dof()));
      }
      const auto count = static_cast<py::ssize_t>(targets.size()) / self.robot().tips();
      if (rows.shape(0) != count) {
        throw_wrong_shape("near", "one row for each of " + std::to_string(count) + " targets",
                          rows);
      }
    }
  }
  return {without_gil(
              [&] { return self.solve_batch(targets, request, nears, threads, interruptible()); }),
          self.robot().dof(), self.robot().tips()};
}

TreeDiagnosis diagnose_tree(const TreeSolver& self, const PoseLike& poses,
                            const TreeKeywords& given) {
  const TreeRequest request = read_tree_request(self, given);
  const std::vector<Pose> targets = as_tip_poses(self, poses, request);
  return without_gil([&] { return self.diagnose(targets, request); });
}

void bind_tree_methods(py::class_<TreeSolver>& cls) {
  def(
      cls, "solve",
      "poses, *, near=None, weights=None, norm='two', filter=None, deadline=None, tasks=None",
      [](const TreeSolver& self, const PoseLike& poses, const std::optional<ArrayLike>& near,
         const std::optional<ArrayLike>& weights, MoveNorm norm,
         const std::optional<TreeFilter>& filter, const std::optional<double>& deadline,
         const std::optional<TaskList>& tasks) {
        return solve_tree(self, poses, near, {weights, norm, filter, deadline, tasks});
      },
      R"(Joint values that put each tip (its TCP, if it has one) at its pose.

Args:
    poses: T_base_tip [m] of each tip, (k, 4, 4), or k others as in Solver.solve.
    near: configuration to stay near, (dof,) [rad or m]; may lie outside the limits. The answer is
        the one with the smallest joint move of those that a bounded search finds, each moved to
        where the move is locally least.
    weights: factor on each joint's part of a move, (dof,), >= 0; None: all 1.
    norm: how a move is measured.
    filter: called with candidates (n, dof), each at the poses and inside the limits; returns n
        truth values. The search continues within its bounds while all are refused.
    deadline: wall-clock time after which the search ends [s]; checked between its stages.
    tasks: what of each tip's pose has to be reached, one for each; None: what the solver's options
        say, of each.

Returns:
    A TreeResult. Poses that cannot be reached are no error but a status.

Raises:
    InvalidArgumentError: wrong shape or dtype, not one pose or task for each tip, a pose that is
        not rigid, a number that is not finite, or a keyword out of range.)");
  def(
      cls, "solve_batch",
      "poses, *, threads=0, near=None, weights=None, norm='two', filter=None, deadline=None, "
      "tasks=None",
      [](const TreeSolver& self, const PoseLike& poses, int threads,
         const std::optional<ArrayLike>& near, const std::optional<ArrayLike>& weights,
         MoveNorm norm, const std::optional<TreeFilter>& filter,
         const std::optional<double>& deadline, const std::optional<TaskList>& tasks) {
        return solve_tree_batch(self, poses, near, threads,
                                {weights, norm, filter, deadline, tasks});
      },
      R"(Solves many targets with the GIL released; row i has the bits of solve(poses[i]).

Args:
    poses: T_base_tip [m] of each tip, (N, k, 4, 4). A row of which one is no pose has
        Status.invalid_pose.
    threads: 0: one per core.
    near: as in solve, or (N, dof): one for each target.
    weights: as in solve.
    norm: as in solve.
    filter: as in solve; called from any thread, one at a time.
    deadline: of each target by itself [s].
    tasks: as in solve.

Returns:
    A TreeBatchResult.

Raises:
    InvalidArgumentError: wrong shape or dtype, or a keyword out of range.)");
  def(
      cls, "diagnose", "poses, *, filter=None, deadline=None, tasks=None",
      [](const TreeSolver& self, const PoseLike& poses, const std::optional<TreeFilter>& filter,
         const std::optional<double>& deadline, const std::optional<TaskList>& tasks) {
        return diagnose_tree(self, poses, {std::nullopt, MoveNorm::two, filter, deadline, tasks});
      },
      R"(Why there is no answer: whether each tip can be reached by itself. Milliseconds.

Args:
    poses: as in solve.
    filter: as in solve.
    deadline: as in solve.
    tasks: as in solve.

Returns:
    A TreeDiagnosis.

Raises:
    InvalidArgumentError: as solve.)");
}

TreeSolver make_tree_solver(const TreeRobot& robot, const std::optional<SolverOptions>& given) {
  const SolverOptions options = given.value_or(SolverOptions());
  options.validate();
  return without_gil([&] { return TreeSolver(robot, options); });
}

py::dict tree_solver_state(const TreeSolver& self) {
  return py::dict("robot"_a = self.robot(), "options"_a = self.options());
}

}  // namespace

void bind_tree_solver(py::module_& m) {
  auto cls = bind_class<TreeSolver>(
      m, "TreeSolver",
      "Solves inverse kinematics for all tips of a TreeRobot at once. Immutable, safe to use from "
      "many threads at once; the same input gives the same bits. The joints that tips share are "
      "set to a value, and behind them each arm is solved for by itself; where that leads nowhere, "
      "all joints are iterated together.");
  def_init(cls, "robot, options=None", fn<&make_tree_solver>,
           R"(Builds the databases of the chains by `options.database`.

Args:
    robot: the robot to solve for.
    options: SolverOptions() if None; tolerances, task and bounds on work hold for each tip.

Raises:
    InvalidArgumentError: an option out of range.)");
  add_property(cls, "robot", &TreeSolver::robot, "The robot it solves for.");
  add_property(
      cls, "options", [](const TreeSolver& self) { return self.options(); },
      "A copy of its options.");
  def(
      cls, "chain_solver", "tip",
      [](const TreeSolver& self, int tip) { return self.chain_solver(tip); },
      "The Solver of one tip's chain by itself; tips count from 0.\n\nRaises:\n"
      "    InvalidArgumentError: no such tip.");
  bind_tree_methods(cls);
  def(cls, "__repr__", "", [](const TreeSolver& self) {
    return "TreeSolver(" + py::cast<std::string>(py::repr(py::cast(self.robot()))) + ", " +
           to_repr(self.options()) + ")";
  });
  def_copies(cls);
  def_pickle(cls, fn<&tree_solver_state>, "robot, options", fn<&make_tree_solver>);
}

}  // namespace iksel::python
