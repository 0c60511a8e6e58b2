// SPDX-License-Identifier: BSD-3-Clause
#include "angle_warning.hpp"
#include "bindings.hpp"
#include "callables.hpp"
#include "keywords.hpp"

namespace iksel::python {

/// A PathResult of a known number of joints, also where it is empty.
struct PyPath : PathResult {
  int dof = 0;

  [[nodiscard]] py::array_t<double> rows() const { return stack_joints(q, dof); }
};

template <>
struct FieldTable<PyPath> : HeaderTable<PyPath, PathResult> {
  using P = PyPath;
  static std::vector<Field> fields() {
    return HeaderFields<P, PathResult>()
        .hide({"q", "first_unreachable", "largest_step_joint", "largest_step_waypoint"})
        .check<&is_length>({"largest_step", "move"})
        .add("dof", &P::dof)
        .all();
  }
  static void check(const P& self) {
    const std::string of = "pickled PathResult, ";
    const auto n = static_cast<std::ptrdiff_t>(self.q.size());
    const auto is_below = [&](const char* name, std::ptrdiff_t index, std::ptrdiff_t end) {
      if (index >= -1 && index < end) return;
      refuse_state(of + name, "-1 to " + std::to_string(end - 1), std::to_string(index));
    };
    if (self.dof < 0 || self.dof > kMaxDof || (n > 0 && self.q.front().size() != self.dof)) {
      refuse_state(of + "dof", "the number of joints of q", std::to_string(self.dof));
    }
    // A path that is not solved has the waypoints before the first unreachable one.
    if (self.first_unreachable != (self.success() ? -1 : n)) {
      refuse_state(of + "first_unreachable", "the number of waypoints unless solved",
                   std::to_string(self.first_unreachable));
    }
    is_below("largest_step_joint", self.largest_step_joint, self.dof);
    is_below("largest_step_waypoint", self.largest_step_waypoint, n);
  }
};

namespace {

PyPath solve_path(const Solver& self, py::handle poses, const Given& given) {
  const int dof = self.robot().dof();
  auto options = given.read<PathOptions>(dof);
  const std::vector<Pose> targets = to_poses(as_rows(self, poses, options));
  if (options.start) warn_of_degrees(self.robot(), {*options.start}, "start");
  options.progress = interruptible();
  return {without_gil([&] { return self.solve_path(targets, options); }), dof};
}

void bind_path_result(py::module_& m) {
  auto cls = bind_fields<PyPath>(m, "Solver.solve_path");
  def_success(cls);
  add_property(cls, "q", &PyPath::rows);
  add_property(cls, "first_unreachable",
               [](const PyPath& self) { return optional_index(self.first_unreachable); });
  add_property(cls, "largest_step_joint",
               [](const PyPath& self) { return optional_index(self.largest_step_joint); });
  add_property(cls, "largest_step_waypoint",
               [](const PyPath& self) { return optional_index(self.largest_step_waypoint); });
}

using Closest = std::optional<PoseWeights>;

Tracker make_tracker(const Solver& solver, const ArrayLike& start, const Closest& closest,
                     const std::optional<Task>& task, const std::optional<std::vector<Task>>& tasks,
                     const std::optional<std::vector<int>>& in_frame_of,
                     const std::optional<Objective>& objective) {
  return Tracker(
      solver, as_joints(start, solver.robot().dof(), "start"), closest,
      {task, tasks.value_or(std::vector<Task>{}), in_frame_of.value_or(std::vector<int>{})},
      objective.value_or(Objective{}));
}

PyResult track(Tracker& self, const PoseLike& pose, double dt, const std::optional<Scene>& scene) {
  const Scene* in = scene ? &*scene : nullptr;
  return PyResult(self.track(as_targets(self.solver(), pose, self.criteria()), dt, in));
}

py::dict tracker_state(const Tracker& self) {
  const TrackerState& state = self.state();
  const auto& [task, tasks, in_frame_of] = self.criteria();
  py::list frames;
  for (const int frame : in_frame_of) frames.append(optional_index(frame));
  return py::dict("solver"_a = self.solver(), "q"_a = to_array(self.q()),
                  "closest"_a = FromPython<Closest>::show(self.closest()),
                  "reached"_a = to_array(*state.reached), "velocity"_a = to_array(state.velocity),
                  "last"_a = to_stack(state.last), "speed"_a = state.speed,
                  "is_at_edge"_a = state.is_at_edge, "task"_a = task, "tasks"_a = tasks,
                  "in_frame_of"_a = frames, "objective"_a = self.objective());
}

Tracker tracker_from_state(const Solver& solver, const ArrayLike& q, const Closest& closest,
                           const ArrayLike& reached, const ArrayLike& velocity,
                           const PoseLike& last, double speed, bool is_at_edge,
                           const std::optional<Task>& task, const std::vector<Task>& tasks,
                           const std::vector<int>& in_frame_of, const Objective& objective) {
  const int dof = solver.robot().dof();
  const std::vector<Pose> targets = to_poses(as_poses(last, "pickled Tracker, last"));
  const TrackerState state{as_joints(reached, dof, "pickled Tracker, reached"),
                           as_joints(velocity, dof, "pickled Tracker, velocity"),
                           {targets.begin(), targets.end()},
                           speed,
                           is_at_edge};
  return Tracker(solver, as_joints(q, dof, "pickled Tracker, q"), closest,
                 {task, tasks, in_frame_of}, objective, state);
}

void bind_tracker(py::module_& m) {
  auto tracker = bind_class<Tracker>(m, "Tracker");
  def_init(tracker,
           "solver, start, *, closest=None, task=None, tasks=None, in_frame_of=None, "
           "objective=None",
           fn<&make_tracker>,
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
    task, tasks, in_frame_of: what of the poses has to be reached, and in the frame of which other
        tip they are, as in Solver.solve.
    objective: an Objective; an arm that its poses leave free moves to where it is least, as fast
        as the poses leave it, and in half a second if it went on as it begins.

Raises:
    InvalidArgumentError: wrong shape or dtype, a number that is not finite, or tasks, frames or
        an objective that do not fit the robot.)");
  def(tracker, "track", "pose, dt, scene=None", fn<&track>,
      R"(Moves on towards a pose, by no more than each joint can in the time step.

Args:
    pose: T_base_tip [m], as in Solver.solve; one for each tip, in the frame that was asked for.
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
  add_property(tracker, "q", [](const Tracker& self) { return to_array(self.q()); });
  add_property(tracker, "reached", [](const Tracker& self) { return to_array(self.reached()); });
  def_repr(tracker);
  def_pickle(tracker, fn<&tracker_state>,
             "solver, q, closest, reached, velocity, last, speed, is_at_edge, task, tasks, "
             "in_frame_of, objective",
             fn<&tracker_from_state>);
}

}  // namespace

void bind_path(py::module_& m, py::class_<Solver>& cls) {
  bind_path_result(m);
  def_method<PathOptions>(
      cls,
      {"solve_path",
       "Joint values along a path of poses, by a choice among the solutions of all waypoints.\n\n"
       "Of all ways through the solutions that are found, the one with the least sum of joint "
       "moves.",
       "poses",
       "T_base_tip of each waypoint, (N, 4, 4) [m], or others as in solve; of several tips "
       "(N, k, 4, 4).",
       R"(Raises:
    InvalidArgumentError: wrong shape or dtype, a pose that is not rigid, a number out of range.)"},
      1,
      {"start", "dt", "weights", "norm", "scene", "exact", "filter", "candidates", "task", "tasks",
       "in_frame_of"},
      fn<&solve_path>);

  bind_tracker(m);
  def(cls, "tracker",
      "start, *, closest=None, task=None, tasks=None, in_frame_of=None, objective=None",
      fn<&make_tracker>, "Tracker(self, start, ...).");
}

}  // namespace iksel::python
