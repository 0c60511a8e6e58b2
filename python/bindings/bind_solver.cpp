// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "angle_warning.hpp"
#include "array_checks.hpp"
#include "bindings.hpp"
#include "filter.hpp"
#include "gil.hpp"
#include "iksel/solver.hpp"
#include "option_fields.hpp"
#include "pickle.hpp"
#include "pose_arguments.hpp"
#include "progress.hpp"
#include "property.hpp"
#include "py_batch.hpp"
#include "py_request.hpp"
#include "py_result.hpp"

namespace iksel::python {

namespace {

template <class T>
std::optional<T> from_optional(const std::optional<Loose<T>>& value, const char* name) {
  if (!value) return std::nullopt;
  return from_python<T>(*value, name);
}

Solver make_solver(const Loose<Robot>& given_robot,
                   const std::optional<Loose<SolverOptions>>& given,
                   const std::optional<Loose<Database>>& given_database,
                   const std::optional<Loose<Robot>>& given_nominal,
                   const std::optional<Loose<std::array<double, 2>>>& max_drift) {
  const auto robot = from_python<Robot>(given_robot, "robot");
  const auto options = given ? from_python<SolverOptions>(*given, "options") : SolverOptions{};
  options.validate();
  const auto database = from_optional<Database>(given_database, "database");
  const auto nominal = from_optional<Robot>(given_nominal, "nominal");
  Drift bound = Solver::kMostDrift;
  if (max_drift) {
    const auto [position, rotation] = from_python<std::array<double, 2>>(*max_drift, "max_drift");
    bound = {position, rotation};
  }
  // Built here and not by Solver, so that Ctrl-C ends a long build.
  const std::optional<ProgressCallable> no_callable;
  const Progress interruptible = make_progress(no_callable);
  const GilRelease release;
  if (nominal) {
    return Solver(robot, options,
                  database ? *database : Database::build(*nominal, options.database, interruptible),
                  *nominal, bound);
  }
  return Solver(robot, options,
                database ? *database : Database::build(robot, options.database, interruptible));
}

PyResult solve(const Solver& self, const PoseLike& pose, const std::optional<ArrayLike>& seed) {
  const Pose target = as_pose(pose, "pose", &self.options().task);
  if (!seed) return {self.solve(target), {}};
  const JointVector start = as_joints(*seed, self.robot().dof(), "seed");
  warn_of_degrees(self.robot(), start, "seed");
  return {self.solve(target, start), {}};
}

/// (N, dof) values, or (dof,) for all targets, which go into the request.
std::optional<DoubleArray> as_near(const std::optional<ArrayLike>& value, py::ssize_t n, int dof,
                                   SolveRequest& request) {
  if (!value) return std::nullopt;
  const DoubleArray array = as_doubles(*value, "near");
  if (array.ndim() == 1) {
    request.near = as_joints(array, dof, "near");
    return std::nullopt;
  }
  if (array.ndim() != 2 || array.shape(0) != n || array.shape(1) != dof) {
    const std::string d = std::to_string(dof);
    throw_wrong_shape("near", "a (" + d + ",) or (" + std::to_string(n) + ", " + d + ") array",
                      array);
  }
  return array;
}

PyBatchResult solve_batch(const Solver& self, const PoseLike& poses, const Loose<int>& threads,
                          const std::optional<ArrayLike>& near,
                          const std::optional<ArrayLike>& weights, const Loose<MoveNorm>& norm,
                          const std::optional<ArrayLike>& seeds, const Loose<bool>& database_seeds,
                          const std::optional<FilterCallable>& filter,
                          const std::optional<Loose<double>>& deadline,
                          const std::optional<Loose<Task>>& task,
                          const std::optional<ObjectiveLike>& objective,
                          const Loose<OnInvalidPose>& on_invalid_pose) {
  SolveRequest request = make_request(self.robot().dof(), std::nullopt, weights, norm, seeds,
                                      database_seeds, filter, deadline, task, objective);
  request.on_invalid_pose = from_python<OnInvalidPose>(on_invalid_pose, "on_invalid_pose");
  const DoubleArray targets = as_poses(poses, "poses", &task_of(self, request));
  const auto thread_count = from_python<int>(threads, "threads");
  const py::ssize_t n = targets.shape(0);
  const py::ssize_t dof = self.robot().dof();
  const auto nears = as_near(near, n, self.robot().dof(), request);
  if (request.near) warn_of_degrees(self.robot(), *request.near, "near");
  PyBatchResult out{py::array_t<double>({n, dof}), py::array_t<bool>(n),
                    py::array_t<std::uint8_t>(n),  py::array_t<double>(n),
                    py::array_t<double>(n),        py::array_t<std::int32_t>(n),
                    py::array_t<std::int32_t>(n),  py::array_t<double>(n)};
  const BatchView view{out.q.mutable_data(),
                       out.status.mutable_data(),
                       out.position_error.mutable_data(),
                       out.rotation_error.mutable_data(),
                       out.attempts.mutable_data(),
                       out.iterations.mutable_data(),
                       out.move.mutable_data()};
  const std::optional<ProgressCallable> no_callable;
  const Progress interruptible = make_progress(no_callable);
  bool* success = out.success.mutable_data();
  const double* in = targets.data();
  {
    const GilRelease release;
    self.solve_batch(in, static_cast<std::size_t>(n), request, nears ? nears->data() : nullptr,
                     view, thread_count, interruptible);
    std::transform(view.status, view.status + n, success, [](std::uint8_t status) {
      return static_cast<Status>(status) == Status::solved;
    });
  }
  return out;
}

py::object solver_state(const Solver& self) {
  return py::make_tuple(self.robot(), self.options(), self.database(), self.nominal());
}

Solver solver_from_state(const py::object& state) {
  PickleState in(state, "Solver", 4);
  const auto robot = in.value<Robot>("robot");
  const auto options = in.value<SolverOptions>("options");
  const auto database = in.value<Database>("database");
  const auto nominal = in.value<Robot>("nominal");
  if (nominal.chain_hash() == robot.chain_hash()) return Solver(robot, options, database);
  // It was within its bound when it was made.
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return Solver(robot, options, database, nominal, Drift{kAny, kAny});
}

}  // namespace

void bind_solver(py::module_& m) {
  bind_enum<MoveNorm>(m);
  bind_enum<SolutionOrder>(m);

  py::class_<Solver> cls(m, "Solver",
                         "Solves inverse kinematics for one robot. Immutable, safe to use from "
                         "many threads at once; the same input gives the same bits.");
  cls.def(py::init(&make_solver), py::arg("robot"), py::arg("options") = py::none(),
          py::arg("database") = py::none(), py::kw_only(), py::arg("nominal") = py::none(),
          py::arg("max_drift") = py::none(),
          R"(Uses a database, or builds one by `options.database` if it is given none.

Args:
    robot: the chain to solve for.
    options: SolverOptions() if None.
    database: built for the same chain; its TCP may differ.
    nominal: for a calibrated arm, the chain that the database was built for, whose constants
        differ a little. Seeds come from it; iterations, tolerances and limits are the robot's.
    max_drift: the largest drift of the robot from `nominal`, (position [m], rotation [rad]);
        None: (0.05, 0.1).

Raises:
    InvalidArgumentError: an option out of range.
    DatabaseMismatchError: the database belongs to another chain, or the drift is too large.)");
  add_property(cls, "nominal", &Solver::nominal,
               "The chain that the database was built for: the robot itself, unless "
               "that is a calibrated one.");
  add_property(
      cls, "drift",
      [](const Solver& self) {
        const Drift drift = self.drift();
        return std::make_pair(drift.position, drift.rotation);
      },
      "How far the robot's tip drifts from `nominal`'s at the same joint values, at most over "
      "2000 configurations: (position [m], rotation [rad]).");
  add_property(cls, "robot", &Solver::robot, "The robot it solves for.");
  add_property(
      cls, "options", [](const Solver& self) { return self.options(); }, "A copy of its options.");
  add_property(cls, "database", &Solver::database, "The database it selects seeds from.");
  add_property(cls, "work_bound", &Solver::work_bound,
               "Most iteration steps that one solve without given seeds can spend, "
               "over all its seeds: max_attempts * max_iterations.");
  add_property(
      cls, "task_hint",
      [](const Solver& self) { return task_hint(self.robot(), self.options().task); },
      "For an arm with fewer joints than its task has axes, which hardly any target suits: tasks "
      "for which its joints are enough, in a sentence; else empty.");
  cls.def("solve", &solve, py::arg("pose"), py::arg("seed") = py::none(),
          R"(Joint values that put the tip (the TCP, if there is one) at a pose.

Args:
    pose: T_base_tip [m]: (4, 4) or (3, 4); a pair (position, rotation) with a (3, 3) matrix or a
        scipy Rotation; an object with as_matrix(), .homogeneous or .A (scipy, Pinocchio,
        spatialmath); (3,) if the task leaves the rotation free. One that is rounded stands for the
        nearest rigid one (see check_pose), by which the errors are measured.
    seed: joint values to iterate from first, (dof,) [rad or m]; may lie outside the limits.

Returns:
    A Result. A pose that cannot be solved is no error but a status.

Raises:
    InvalidArgumentError: wrong shape or dtype, a pose that is not rigid, or a number that is
        not finite.)");
  bind_requests(m, cls);
  bind_path(m, cls);
  const SolveRequest wishes;
  cls.def("solve_batch", &solve_batch, py::arg("poses"), py::arg("threads") = 0, py::kw_only(),
          py::arg("near") = py::none(), py::arg("weights") = py::none(),
          py::arg("norm") = enum_name(wishes.norm), py::arg("seeds") = py::none(),
          py::arg("database_seeds") = wishes.database_seeds, py::arg("filter") = py::none(),
          py::arg("deadline") = py::none(), py::arg("task") = py::none(),
          py::arg("objective") = py::none(),
          py::arg("on_invalid_pose") = enum_name(wishes.on_invalid_pose),
          R"(Solves many targets with the GIL released; row i belongs to target i.

A row has the same bits whatever the number of threads and whatever else is in the batch. Its
status is that of solve(), and so are its bits, but for seeds in SIMD lanes (the default preset):
there a target has a lane to itself, and the answer may be another of its solutions, within the
same tolerances.

Args:
    poses: T_base_tip, (N, 4, 4) [m], or others as in solve. Doubles in C order are read in place.
    threads: 0: one per core.
    near: configuration to stay near, (dof,), or one for each target, (N, dof) [rad or m].
    filter: called with candidates (n, dof), first the answers of up to 256 targets at once;
        returns n truth values. Where it refuses, the search for that target goes on.
    weights, norm, seeds, database_seeds, deadline, task, objective: as in solve, for each target
        by itself.
    on_invalid_pose: what a row does that is no pose (see check_pose): "status", Status.invalid_pose
        for it and NaN for its q; "raise", an error that names the first, and none is solved.

Raises:
    InvalidArgumentError: wrong shape or dtype, a bad wish, or by wish a bad pose.)");
  cls.def("__repr__", [](const Solver& self) {
    return "Solver(" + py::cast<std::string>(py::repr(py::cast(self.robot()))) + ", " +
           to_repr(self.options()) + ")";
  });
  cls.def("__copy__", [](const Solver& self) { return self; });
  cls.def(
      "__deepcopy__", [](const Solver& self, const py::dict&) { return self; }, py::arg("memo"));
  cls.def(py::pickle(&solver_state, &solver_from_state));
}

}  // namespace iksel::python
