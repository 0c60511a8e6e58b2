// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "angle_warning.hpp"
#include "array_checks.hpp"
#include "bindings.hpp"
#include "filter.hpp"
#include "iksel/solver.hpp"
#include "option_fields.hpp"
#include "progress.hpp"
#include "py_request.hpp"
#include "py_result.hpp"

namespace iksel::python {

namespace {

/// The arrays of a batch.
struct PyBatchResult {
  py::array_t<double> q;
  py::array_t<bool> success;
  py::array_t<std::uint8_t> status;
  py::array_t<double> position_error;
  py::array_t<double> rotation_error;
  py::array_t<std::int32_t> attempts;
  py::array_t<std::int32_t> iterations;
  py::array_t<double> move;

  [[nodiscard]] py::ssize_t size() const { return status.shape(0); }

  [[nodiscard]] py::ssize_t solved() const {
    const bool* first = success.data();
    return std::count(first, first + size(), true);
  }

  [[nodiscard]] PyResult row(const Loose<py::ssize_t>& index) const {
    auto i = from_python<py::ssize_t>(index, "i");
    if (i < 0) i += size();
    if (i < 0 || i >= size()) {
      throw py::index_error("row " + std::to_string(i) + " of " + std::to_string(size()));
    }
    PyResult out;
    out.result.status = static_cast<Status>(status.at(i));
    if (out.result.success()) {
      out.result.q = Eigen::Map<const Eigen::VectorXd>(q.data(i), q.shape(1));
    }
    out.result.position_error = position_error.at(i);
    out.result.rotation_error = rotation_error.at(i);
    out.result.attempts = attempts.at(i);
    out.result.iterations = iterations.at(i);
    out.result.move = move.at(i);
    return out;
  }
};

Solver make_solver(const Robot& robot, const std::optional<SolverOptions>& given,
                   const std::optional<Database>& database, const std::optional<Robot>& nominal,
                   const std::optional<std::pair<double, double>>& max_drift) {
  const SolverOptions options = given.value_or(SolverOptions{});
  options.validate();
  // Built here and not by Solver, so that Ctrl-C ends a long build.
  const std::optional<ProgressCallable> no_callable;
  const Progress interruptible = make_progress(no_callable);
  const py::gil_scoped_release release;
  if (nominal) {
    const Drift bound = max_drift ? Drift{max_drift->first, max_drift->second} : Solver::kMostDrift;
    return Solver(robot, options,
                  database ? *database : Database::build(*nominal, options.database, interruptible),
                  *nominal, bound);
  }
  return Solver(robot, options,
                database ? *database : Database::build(robot, options.database, interruptible));
}

PyResult solve(const Solver& self, const ArrayLike& pose, const std::optional<ArrayLike>& seed) {
  const Pose target = as_pose(pose, "pose");
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

PyBatchResult solve_batch(const Solver& self, const ArrayLike& poses, const Loose<int>& threads,
                          const std::optional<ArrayLike>& near,
                          const std::optional<ArrayLike>& weights, const Loose<MoveNorm>& norm,
                          const std::optional<ArrayLike>& seeds, const Loose<bool>& database_seeds,
                          const std::optional<FilterCallable>& filter,
                          const std::optional<Loose<double>>& deadline,
                          const std::optional<Loose<Task>>& task,
                          const std::optional<ObjectiveLike>& objective) {
  const DoubleArray targets = as_poses(poses, "poses");
  const auto thread_count = from_python<int>(threads, "threads");
  const py::ssize_t n = targets.shape(0);
  const py::ssize_t dof = self.robot().dof();
  SolveRequest request = make_request(self.robot().dof(), std::nullopt, weights, norm, seeds,
                                      database_seeds, filter, deadline, task, objective);
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
    const py::gil_scoped_release release;
    self.solve_batch(in, static_cast<std::size_t>(n), request, nears ? nears->data() : nullptr,
                     view, thread_count, interruptible);
    std::transform(view.status, view.status + n, success, [](std::uint8_t status) {
      return static_cast<Status>(status) == Status::solved;
    });
  }
  return out;
}

std::string scientific(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string result_repr(const PyResult& self) {
  const Result& r = self.result;
  return std::string("Result(") + enum_name(r.status) +
         ", position_error=" + scientific(r.position_error) +
         ", rotation_error=" + scientific(r.rotation_error) +
         ", attempts=" + std::to_string(r.attempts) +
         ", iterations=" + std::to_string(r.iterations) + ")";
}

void bind_result(py::module_& m) {
  py::class_<PyResult> cls(m, "Result",
                           "Answer to one target. Everything in it is measured on the returned q.");
  cls.def_property_readonly(
      "success", [](const PyResult& self) { return self.result.success(); },
      "Whether q reaches the target within both tolerances and lies inside the limits.");
  cls.def_property_readonly(
      "status", [](const PyResult& self) { return self.result.status; }, "Why the solve ended.");
  cls.def_property_readonly("q", &PyResult::joints,
                            "Joint values [rad or m], (dof,); None unless solved.");
  cls.def_property_readonly(
      "position_error", [](const PyResult& self) { return self.result.position_error; },
      "Distance to the target [m]; NaN unless solved.");
  cls.def_property_readonly(
      "rotation_error", [](const PyResult& self) { return self.result.rotation_error; },
      "Length of the rotation vector to the target [rad]; NaN unless solved.");
  cls.def_property_readonly(
      "move", [](const PyResult& self) { return self.result.move; },
      "Length of the move from `near`, by its norm and weights; NaN without one.");
  cls.def_property_readonly(
      "cost", [](const PyResult& self) { return self.result.cost; },
      "Cost of q by the objective; NaN without one.");
  cls.def_property_readonly(
      "attempts", [](const PyResult& self) { return self.result.attempts; }, "Seeds tried.");
  cls.def_property_readonly(
      "iterations", [](const PyResult& self) { return self.result.iterations; },
      "Iteration steps over all attempts.");
  cls.def("__repr__", &result_repr);
  cls.def(py::pickle(
      [](PyResult& self) {
        const Result& r = self.result;
        return py::make_tuple(enum_name(r.status), self.joints(), r.position_error,
                              r.rotation_error, r.attempts, r.iterations, r.move, r.cost);
      },
      [](const py::tuple& state) {
        PyResult self;
        self.result.status = from_python<Status>(state[0], "status");
        self.q = state[1];
        self.result.position_error = py::cast<double>(state[2]);
        self.result.rotation_error = py::cast<double>(state[3]);
        self.result.attempts = py::cast<int>(state[4]);
        self.result.iterations = py::cast<int>(state[5]);
        self.result.move = py::cast<double>(state[6]);
        self.result.cost = py::cast<double>(state[7]);
        return self;
      }));
}

void bind_batch_result(py::module_& m) {
  using B = PyBatchResult;
  py::class_<B> cls(m, "BatchResult",
                    "Answers to many targets as arrays; row i belongs to target i. Indexing gives "
                    "a Result.");
  cls.def_readonly("q", &B::q, "Joint values [rad or m], (N, dof); NaN where not solved.");
  cls.def_readonly("success", &B::success, "Whether each target is solved, (N,).");
  cls.def_readonly("status", &B::status, "Values of Status, (N,).");
  cls.def_readonly("position_error", &B::position_error,
                   "Distances to the targets [m], (N,); NaN where not solved.");
  cls.def_readonly("rotation_error", &B::rotation_error,
                   "Lengths of the rotation vectors to the targets [rad], (N,); NaN where not "
                   "solved.");
  cls.def_readonly("attempts", &B::attempts, "Seeds tried, (N,).");
  cls.def_readonly("iterations", &B::iterations, "Iteration steps over all attempts, (N,).");
  cls.def_readonly("move", &B::move,
                   "Lengths of the moves from `near`, (N,); NaN where not solved or without one.");
  cls.def_property_readonly("solved", &B::solved, "Number of targets solved.");
  cls.def(
      "statuses",
      [](const B& self) {
        std::vector<Status> statuses;
        statuses.reserve(static_cast<std::size_t>(self.size()));
        for (py::ssize_t i = 0; i < self.size(); ++i) {
          statuses.push_back(static_cast<Status>(self.status.at(i)));
        }
        return statuses;
      },
      "`status` as members of Status.");
  cls.def("__len__", &B::size);
  cls.def("__getitem__", &B::row, py::arg("i"));
  cls.def("__iter__", [](const py::object& self) {
    return py::reinterpret_steal<py::typing::Iterator<PyResult>>(PySeqIter_New(self.ptr()));
  });
  cls.def("__repr__", [](const B& self) {
    return "BatchResult(" + std::to_string(self.solved()) + " of " + std::to_string(self.size()) +
           " solved)";
  });
  cls.def(py::pickle(
      [](const B& self) {
        return py::make_tuple(self.q, self.success, self.status, self.position_error,
                              self.rotation_error, self.attempts, self.iterations, self.move);
      },
      [](const py::tuple& state) {
        B self{
            state[0].cast<py::array_t<double>>(),       state[1].cast<py::array_t<bool>>(),
            state[2].cast<py::array_t<std::uint8_t>>(), state[3].cast<py::array_t<double>>(),
            state[4].cast<py::array_t<double>>(),       state[5].cast<py::array_t<std::int32_t>>(),
            state[6].cast<py::array_t<std::int32_t>>(), state[7].cast<py::array_t<double>>()};
        return self;
      }));
}

}  // namespace

void bind_solver(py::module_& m) {
  bind_enum<Status>(m);
  bind_enum<MoveNorm>(m);
  bind_enum<SolutionOrder>(m);
  bind_result(m);
  bind_batch_result(m);

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
  cls.def_property_readonly("nominal", &Solver::nominal,
                            "The chain that the database was built for: the robot itself, unless "
                            "that is a calibrated one.");
  cls.def_property_readonly(
      "drift",
      [](const Solver& self) {
        const Drift drift = self.drift();
        return std::make_pair(drift.position, drift.rotation);
      },
      "How far the robot's tip drifts from `nominal`'s at the same joint values, at most over "
      "2000 configurations: (position [m], rotation [rad]).");
  cls.def_property_readonly("robot", &Solver::robot, "The robot it solves for.");
  cls.def_property_readonly(
      "options", [](const Solver& self) { return self.options(); }, "A copy of its options.");
  cls.def_property_readonly("database", &Solver::database, "The database it selects seeds from.");
  cls.def_property_readonly("work_bound", &Solver::work_bound,
                            "Most iteration steps that one solve without given seeds can spend, "
                            "over all its seeds: max_attempts * max_iterations.");
  cls.def("solve", &solve, py::arg("pose"), py::arg("seed") = py::none(),
          R"(Joint values that put the tip (the TCP, if there is one) at a pose.

Args:
    pose: T_base_tip, (4, 4) [m].
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
          R"(Solves many targets with the GIL released; row i belongs to target i.

A row has the same bits whatever the number of threads and whatever else is in the batch. Its
status is that of solve(), and so are its bits, but for seeds in SIMD lanes (the default preset):
there a target has a lane to itself, and the answer may be another of its solutions, within the
same tolerances.

Args:
    poses: T_base_tip, (N, 4, 4) [m]. Doubles in C order are read in place.
    threads: 0: one per core.
    near: configuration to stay near, (dof,), or one for each target, (N, dof) [rad or m].
    filter: called with candidates (n, dof), first the answers of up to 256 targets at once;
        returns n truth values. Where it refuses, the search for that target goes on.
    weights, norm, seeds, database_seeds, deadline, task, objective: as in solve, for each target
        by itself.

Raises:
    InvalidArgumentError: wrong shape or dtype, a bad wish, or a bad pose; the first is named, and
        none is solved.)");
  cls.def("__repr__", [](const Solver& self) {
    return "Solver(" + py::cast<std::string>(py::repr(py::cast(self.robot()))) + ", " +
           to_repr(self.options()) + ")";
  });
  cls.def("__copy__", [](const Solver& self) { return self; });
  cls.def(
      "__deepcopy__", [](const Solver& self, const py::dict&) { return self; }, py::arg("memo"));
  cls.def(py::pickle(
      [](const Solver& self) {
        return py::make_tuple(self.robot(), self.options(), self.database(), self.nominal());
      },
      [](const py::tuple& state) {
        const auto& robot = py::cast<const Robot&>(state[0]);
        const auto& options = py::cast<const SolverOptions&>(state[1]);
        const auto& database = py::cast<const Database&>(state[2]);
        const auto& nominal = py::cast<const Robot&>(state[3]);
        if (nominal.chain_hash() == robot.chain_hash()) return Solver(robot, options, database);
        // It was within its bound when it was made.
        constexpr double kAny = std::numeric_limits<double>::infinity();
        return Solver(robot, options, database, nominal, Drift{kAny, kAny});
      }));
}

}  // namespace iksel::python
