// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "angle_warning.hpp"
#include "array_checks.hpp"
#include "bindings.hpp"
#include "gil.hpp"
#include "html.hpp"
#include "iksel/path.hpp"
#include "iksel/tracker.hpp"
#include "pickle.hpp"
#include "pose_arguments.hpp"
#include "progress.hpp"
#include "property.hpp"
#include "py_result.hpp"
#include "python_types.hpp"
#include "request_keywords.hpp"

namespace iksel::python {

namespace {

struct PyPath {
  PathResult path;
  int dof = 0;

  [[nodiscard]] py::array_t<double> q() const {
    py::array_t<double> array(
        {static_cast<py::ssize_t>(path.q.size()), static_cast<py::ssize_t>(dof)});
    double* out = array.mutable_data();
    for (const JointVector& q : path.q) {
      out = std::copy_n(q.data(), static_cast<std::size_t>(dof), out);
    }
    return array;
  }
};

using OptionalIndex = py::typing::Optional<py::int_>;

OptionalIndex optional_index(std::ptrdiff_t index) {
  const py::object value = index < 0 ? py::object(py::none()) : py::object(py::int_(index));
  return py::reinterpret_borrow<OptionalIndex>(value);
}

py::object solve_path(const Solver& self, py::handle poses, const Given& given) {
  const int dof = self.robot().dof();
  const DoubleArray array = as_poses(poses, "poses", &self.options().task);
  std::vector<Pose> targets(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < targets.size(); ++i) {
    targets[i].matrix() = Eigen::Map<const RowMajorPose>(array.data() + 16 * i);
  }
  auto options = given.read<PathOptions>(dof);
  if (options.start) warn_of_degrees(self.robot(), {*options.start}, "start");
  const std::optional<ProgressCallable> no_callable;
  options.progress = make_progress(no_callable);
  return py::cast(PyPath{without_gil([&] { return self.solve_path(targets, options); }), dof});
}

py::object path_state(const PyPath& self) {
  const PathResult& p = self.path;
  return py::make_tuple(enum_name(p.status), self.q(), p.first_unreachable, p.largest_step,
                        p.largest_step_joint, p.largest_step_waypoint, p.move);
}

PyPath path_from_state(const py::object& state) {
  PickleState in(state, "PathResult", 7);
  PyPath out;
  PathResult& path = out.path;
  path.status = in.value<Status>("status");
  const auto q = in.rows("q");
  const py::ssize_t n = q.shape(0);
  out.dof = static_cast<int>(q.shape(1));
  for (py::ssize_t i = 0; i < n; ++i) {
    check_finite(q.data(i), out.dof, "pickled PathResult, q[" + std::to_string(i) + "]");
    path.q.emplace_back(Eigen::Map<const Eigen::VectorXd>(q.data(i), out.dof));
  }
  // A path that is not solved has the waypoints before the first unreachable one.
  path.first_unreachable = in.index<std::ptrdiff_t>("first_unreachable", n + 1);
  if (path.first_unreachable != (path.success() ? -1 : n)) {
    in.refuse("first_unreachable", "the number of waypoints unless solved",
              std::to_string(path.first_unreachable));
  }
  path.largest_step = in.length("largest_step", /*may_be_nan=*/false);
  path.largest_step_joint = in.index<int>("largest_step_joint", out.dof);
  path.largest_step_waypoint = in.index<std::ptrdiff_t>("largest_step_waypoint", n);
  path.move = in.length("move", /*may_be_nan=*/false);
  return out;
}

void bind_path_result(py::module_& m) {
  py::class_<PyPath> cls(m, "PathResult",
                         "Joint values along a path; true if there are any for every waypoint.");
  add_property(
      cls, "success", [](const PyPath& self) { return self.path.success(); },
      "Whether there is a configuration for every waypoint.");
  add_property(
      cls, "status", [](const PyPath& self) { return self.path.status; },
      "`solved`, or why waypoint `first_unreachable` has none: `too_fast` if it has solutions, but "
      "no joint "
      "path leads there in time.");
  add_property(cls, "q", &PyPath::q,
               "Joint values [rad or m], (N, dof); unless solved, of the waypoints before that.");
  add_property(
      cls, "first_unreachable",
      [](const PyPath& self) { return optional_index(self.path.first_unreachable); },
      "Index of the first waypoint that has no continuation; None if solved.");
  add_property(
      cls, "largest_step", [](const PyPath& self) { return self.path.largest_step; },
      "The farthest that a joint moves from one waypoint to the next [rad or m].");
  add_property(
      cls, "largest_step_joint",
      [](const PyPath& self) { return optional_index(self.path.largest_step_joint); },
      "Index of the joint that does; None if there is no step.");
  add_property(
      cls, "largest_step_waypoint",
      [](const PyPath& self) { return optional_index(self.path.largest_step_waypoint); },
      "Index of the waypoint where that step ends; None if there is no step.");
  add_property(
      cls, "move", [](const PyPath& self) { return self.path.move; }, "Sum of the joint moves.");
  cls.def("__bool__", [](const PyPath& self) { return self.path.success(); });
  cls.def(py::pickle(&path_state, &path_from_state));
  cls.def("__repr__", [](const PyPath& self) {
    return std::string("PathResult(") + enum_name(self.path.status) + ", " +
           std::to_string(self.path.q.size()) + " waypoints" +
           (self.path.success()
                ? ""
                : ", first_unreachable=" + std::to_string(self.path.first_unreachable)) +
           ")";
  });
}

Tracker make_tracker(const Solver& solver, const ArrayLike& start, const ClosestLike& closest) {
  return Tracker(solver, as_joints(start, solver.robot().dof(), "start"), as_closest(closest));
}

/// What `closest` was asked for with.
py::object weights_of(const Tracker& tracker) {
  const auto& weights = tracker.closest();
  if (!weights) return py::none();
  if (!weights->rotation) return py::bool_(true);
  JointVector six(6);
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    six[i] = weights->position[k];
    six[3 + i] = (*weights->rotation)[k];
  }
  return to_array(six);
}

void bind_tracker(py::module_& m) {
  py::class_<Tracker> tracker(
      m, "Tracker",
      "Follows a stream of poses: each answer continues from the last, within the velocity limits. "
      "Not to be used from two threads at once.");
  tracker.def(
      py::init([](const Loose<Solver>& given, const ArrayLike& start, const ClosestLike& closest) {
        const auto solver = from_python<Solver>(given, "solver");
        return make_tracker(solver, start, closest);
      }),
      py::arg("solver"), py::arg("start"), py::kw_only(), py::arg("closest") = py::none(),
      R"(Begins where the arm is.

Args:
    solver: what solves.
    start: joint values, (dof,) [rad or m], as measured; outside the limits, the way back inside is
        part of the first moves.
    closest: True, or six weights as in Solver.solve: at poses that cannot be reached from where
        the arm is, it goes downhill to where it is nearest, with Status.closest, and comes back
        with the target on the side that it left from. The tool is at most three times as fast
        as the target, both measured by the weights; a target at rest counts as fast as it last
        was.

Raises:
    InvalidArgumentError: wrong shape or dtype, or a number that is not finite.)");
  tracker.def(
      "track",
      [](Tracker& self, const PoseLike& pose, const Loose<double>& dt,
         const std::optional<Loose<Scene>>& scene) {
        const Pose target = as_pose(pose, "pose");
        const auto step = from_python<double>(dt, "dt");
        if (!scene) return PyResult{self.track(target, step), {}};
        const auto around = from_python<Scene>(*scene, "scene");
        return PyResult{self.track(target, step, &around), {}};
      },
      py::arg("pose"), py::arg("dt"), py::arg("scene") = py::none(),
      R"(Moves on towards a pose, by no more than each joint can in the time step.

Args:
    pose: T_base_tip [m], as in Solver.solve.
    dt: time step [s].
    scene: the arm stays, with status `in_collision`, where it would collide at the end of its move;
        the way there is not looked at.

Returns:
    A Result. Status `solved`: there. `too_fast`: the arm needs more time, and went as far on the
    straight way in joint space as it, or its tool, could. `closest`: not there, but as near as it gets from
    here. Any other: no continuation, and the arm stays.

Raises:
    InvalidArgumentError: wrong shape or dtype, a pose that is not rigid, dt not above 0, or a
        scene of another chain.)");
  add_property(
      tracker, "q", [](const Tracker& self) { return to_array(self.q()); },
      "Where the arm is now, (dof,) [rad or m]; once inside the limits, always inside.");
  add_property(
      tracker, "reached", [](const Tracker& self) { return to_array(self.reached()); },
      "Where it was when it last reached its pose, or began, (dof,) [rad or m].");
  tracker.def("__repr__", [](const Tracker& self) {
    const JointVector& q = self.q();
    return "Tracker(" + py::cast<std::string>(py::repr(py::cast(self.solver().robot()))) +
           ", q=" + short_numbers(q.data(), static_cast<std::size_t>(q.size())) + ")";
  });
  tracker.def(py::pickle(
      [](const Tracker& self) -> py::object {
        const auto& [last, speed] = self.stream();
        return py::make_tuple(
            self.solver(), to_array(self.q()), weights_of(self), to_array(self.reached()),
            last ? py::object(to_array(Pose(*last))) : py::object(py::none()), speed);
      },
      [](const py::object& state) {
        PickleState in(state, "Tracker", 6);
        const auto solver = in.value<Solver>("solver");
        const int dof = solver.robot().dof();
        const JointVector q = as_joints(in.object(), dof, "pickled Tracker, q");
        const auto closest = as_closest(in.object());
        const JointVector reached = as_joints(in.object(), dof, "pickled Tracker, reached");
        TargetStream stream;
        const py::object last = in.object();
        if (!last.is_none()) stream.last = as_pose(last, "pickled Tracker, target");
        stream.speed = in.value<double>("speed");
        return Tracker(solver, q, closest, reached, stream);
      }));
}

}  // namespace

void bind_path(py::module_& m, py::class_<Solver>& cls) {
  bind_path_result(m);
  def_method<1>(
      cls,
      {"solve_path",
       "Joint values along a path of poses, by a choice among the solutions of all waypoints.\n\n"
       "Of all ways through the solutions that are found, the one with the least sum of joint "
       "moves.",
       "poses", "T_base_tip of each waypoint, (N, 4, 4) [m], or others as in solve.", "PathResult",
       R"(Raises:
    InvalidArgumentError: wrong shape or dtype, a pose that is not rigid, a number out of range.)"},
      path_keywords(), {"start", "dt", "weights", "norm", "scene", "exact", "filter", "candidates"},
      &solve_path);

  bind_tracker(m);
  cls.def("tracker", &make_tracker, py::arg("start"), py::kw_only(),
          py::arg("closest") = py::none(), "Tracker(self, start, closest=closest).");
}

}  // namespace iksel::python
