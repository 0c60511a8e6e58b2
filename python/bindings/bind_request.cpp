// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "angle_warning.hpp"
#include "array_checks.hpp"
#include "bindings.hpp"
#include "filter.hpp"
#include "gil.hpp"
#include "html.hpp"
#include "iksel/diagnosis.hpp"
#include "iksel/solver.hpp"
#include "pickle.hpp"
#include "pose_arguments.hpp"
#include "property.hpp"
#include "py_batch.hpp"
#include "py_request.hpp"
#include "py_result.hpp"
#include "python_types.hpp"
#include "task_fields.hpp"

namespace iksel::python {

namespace {

/// The distinct solutions for one target.
struct PySolutions {
  Solutions solutions;
  int dof = 0;

  [[nodiscard]] py::ssize_t size() const { return static_cast<py::ssize_t>(solutions.all.size()); }

  [[nodiscard]] py::array_t<double> q() const {
    py::array_t<double> array({size(), static_cast<py::ssize_t>(dof)});
    double* out = array.mutable_data();
    for (const Result& result : solutions.all) {
      out = std::copy_n(result.q.data(), static_cast<std::size_t>(dof), out);
    }
    return array;
  }

  template <class T>
  [[nodiscard]] py::array_t<T> column(T Result::*member) const {
    py::array_t<T> array(size());
    T* out = array.mutable_data();
    for (const Result& result : solutions.all) *out++ = result.*member;
    return array;
  }

  [[nodiscard]] PyResult row(const RowIndex& index) const {
    return {solutions.all[static_cast<std::size_t>(as_row(index, size(), "solution"))], {}};
  }
};

PyResult solve_request(const Solver& self, const PoseLike& pose,
                       const std::optional<ArrayLike>& near,
                       const std::optional<ArrayLike>& weights, const Loose<MoveNorm>& norm,
                       const std::optional<ArrayLike>& seeds, const Loose<bool>& database_seeds,
                       const std::optional<FilterCallable>& filter,
                       const std::optional<Loose<double>>& deadline,
                       const std::optional<Loose<Task>>& task,
                       const std::optional<ObjectiveLike>& objective) {
  const SolveRequest request = make_request(self.robot().dof(), near, weights, norm, seeds,
                                            database_seeds, filter, deadline, task, objective);
  const Pose target = as_pose(pose, "pose", &task_of(self, request));
  if (request.near) warn_of_degrees(self.robot(), *request.near, "near");
  const GilRelease release;
  return {self.solve(target, request), {}};
}

PySolutions solve_all(const Solver& self, const PoseLike& pose, const Loose<int>& max,
                      const Loose<double>& min_distance, const Loose<bool>& whole_turns,
                      const Loose<SolutionOrder>& order, const std::optional<ArrayLike>& near,
                      const std::optional<ArrayLike>& weights, const Loose<MoveNorm>& norm,
                      const std::optional<ArrayLike>& seeds, const Loose<bool>& database_seeds,
                      const std::optional<FilterCallable>& filter,
                      const std::optional<Loose<double>>& deadline,
                      const std::optional<Loose<Task>>& task) {
  const int dof = self.robot().dof();
  AllOptions options;
  options.max = from_python<int>(max, "max");
  options.min_distance = from_python<double>(min_distance, "min_distance");
  options.whole_turns = from_python<bool>(whole_turns, "whole_turns");
  options.order = from_python<SolutionOrder>(order, "order");
  const SolveRequest request =
      make_request(dof, near, weights, norm, seeds, database_seeds, filter, deadline, task, {});
  const Pose target = as_pose(pose, "pose", &task_of(self, request));
  if (request.near) warn_of_degrees(self.robot(), *request.near, "near");
  const GilRelease release;
  return {self.solve_all(target, options, request), dof};
}

Diagnosis diagnose(const Solver& self, const PoseLike& pose,
                   const std::optional<FilterCallable>& filter,
                   const std::optional<Loose<double>>& deadline,
                   const std::optional<Loose<Task>>& task) {
  SolveRequest request;
  if (filter) request.filter = make_filter(*filter, self.robot().dof());
  if (deadline) request.deadline = from_python<double>(*deadline, "deadline");
  if (task) request.task = from_python<Task>(*task, "task");
  const Pose target = as_pose(pose, "pose", &task_of(self, request));
  const GilRelease release;
  return self.diagnose(target, request);
}

py::object solutions_state(const PySolutions& self) {
  const Solutions& s = self.solutions;
  return py::make_tuple(enum_name(s.status), self.q(), self.column(&Result::position_error),
                        self.column(&Result::rotation_error), self.column(&Result::move),
                        self.column(&Result::cost), s.attempts, s.iterations);
}

PySolutions solutions_from_state(const py::object& state) {
  PickleState in(state, "Solutions", 8);
  Solutions out;
  out.status = in.value<Status>("status");
  const auto q = in.rows("q");
  const py::ssize_t n = q.shape(0);
  const int dof = static_cast<int>(q.shape(1));
  if (out.success() != (n > 0)) in.refuse("q", "solutions where solved, and only there", "others");
  const auto position_error = in.column<double>("position_error", n);
  const auto rotation_error = in.column<double>("rotation_error", n);
  const auto move = in.column<double>("move", n);
  const auto cost = in.column<double>("cost", n);
  out.attempts = in.count("attempts");
  out.iterations = in.count("iterations");
  for (py::ssize_t i = 0; i < n; ++i) {
    check_finite(q.data(i), dof, "pickled Solutions, q[" + std::to_string(i) + "]");
    if (!(position_error.at(i) >= 0 && rotation_error.at(i) >= 0)) {
      in.refuse("errors", "0 or more", "others");
    }
    Result& r = out.all.emplace_back();
    r.status = Status::solved;
    r.q = Eigen::Map<const Eigen::VectorXd>(q.data(i), dof);
    r.position_error = position_error.at(i);
    r.rotation_error = rotation_error.at(i);
    r.move = move.at(i);
    r.cost = cost.at(i);
    r.attempts = out.attempts;
    r.iterations = out.iterations;
  }
  return {out, dof};
}

std::string solutions_repr(const PySolutions& self) {
  const auto& all = self.solutions.all;
  std::string best;
  if (!all.empty()) {
    const JointVector& q = all.front().q;
    best = ", best q=" + short_numbers(q.data(), static_cast<std::size_t>(q.size()));
  }
  return std::string("Solutions(") + enum_name(self.solutions.status) + ", " +
         std::to_string(all.size()) + " solutions" + best + ")";
}

std::string solutions_html(const PySolutions& self) {
  const auto& all = self.solutions.all;
  std::vector<std::string> header = {""};
  for (int i = 0; i < self.dof; ++i) header.push_back("q[" + std::to_string(i) + "]");
  header.insert(header.end(), {"position error [m]", "rotation error [rad]", "move"});
  HtmlTable table(std::to_string(all.size()) + " solutions, " + enum_name(self.solutions.status),
                  header);
  const std::size_t shown = std::min(all.size(), HtmlTable::kMostRows);
  for (std::size_t i = 0; i < shown; ++i) {
    std::vector<std::string> cells = {std::to_string(i)};
    for (const double q : all[i].q) cells.push_back(short_number(q));
    for (const double x : {all[i].position_error, all[i].rotation_error, all[i].move}) {
      cells.push_back(short_number(x, 3));
    }
    table.add_row(cells);
  }
  table.add_rest(all.size() - shown);
  return table.text();
}

void bind_solutions(py::module_& m) {
  using S = PySolutions;
  py::class_<S> cls(m, "Solutions",
                    "The distinct solutions for one target, best first; true if there are any. "
                    "Indexing gives a Result.");
  add_property(
      cls, "success", [](const S& self) { return self.solutions.success(); },
      "Whether there is at least one.");
  add_property(
      cls, "status", [](const S& self) { return self.solutions.status; },
      "`solved`, or why there is none.");
  add_property(cls, "q", &S::q, "Joint values [rad or m], (n, dof).");
  add_property(
      cls, "position_error", [](const S& self) { return self.column(&Result::position_error); },
      "Distances to the target [m], (n,).");
  add_property(
      cls, "rotation_error", [](const S& self) { return self.column(&Result::rotation_error); },
      "Lengths of the rotation vectors to the target [rad], (n,).");
  add_property(
      cls, "move", [](const S& self) { return self.column(&Result::move); },
      "Lengths of the moves from `near`, (n,); NaN without one.");
  add_property(
      cls, "attempts", [](const S& self) { return self.solutions.attempts; }, "Seeds tried.");
  add_property(
      cls, "iterations", [](const S& self) { return self.solutions.iterations; },
      "Iteration steps over all attempts.");
  cls.def("__len__", &S::size);
  cls.def("__getitem__", &S::row, py::arg("i"));
  cls.def("__iter__", &iterate_rows);
  cls.def("__bool__", [](const S& self) { return self.solutions.success(); });
  cls.def("__repr__", &solutions_repr);
  cls.def("_repr_html_", &solutions_html);
  cls.def(py::pickle(&solutions_state, &solutions_from_state));
}

}  // namespace

void bind_requests(py::module_& m, py::class_<Solver>& cls) {
  bind_solutions(m);
  const SolveRequest wishes;
  const AllOptions all;
  const char* norm = enum_name(wishes.norm);
  // A second overload, so that plain solving pays nothing for the wishes.
  cls.def("solve", &solve_request, py::arg("pose"), py::kw_only(), py::arg("near") = py::none(),
          py::arg("weights") = py::none(), py::arg("norm") = norm, py::arg("seeds") = py::none(),
          py::arg("database_seeds") = wishes.database_seeds, py::arg("filter") = py::none(),
          py::arg("deadline") = py::none(), py::arg("task") = py::none(),
          py::arg("objective") = py::none(),
          R"(As solve, with wishes.

Args:
    pose: T_base_tip [m], in one of the forms of solve above.
    near: configuration to stay near, (dof,) [rad or m]; may lie outside the limits. The answer
        is the one with the smallest joint move of all that are found, whole turns considered; a
        redundant arm's has slid along its self-motion to where the move is smallest. Angles
        here, in `seeds` and in a posture that are too large for a double to tell poses apart to
        a tenth of the tolerances are refused: 1.5e8 rad for an arm of six joints and 1 m at the
        default tolerances, never less than 100 rad.
    weights: factor on each joint's part of the move, (dof,), >= 0; None: all 1.
    norm: how the move is measured.
    seeds: joint values to iterate from, (N, dof) [rad or m]; ranked as the database's seeds, and
        tried before them: up to max_attempts, and as many of the database's on top.
    database_seeds: whether the database's seeds follow the given ones.
    filter: called with candidates (n, dof), each at the pose and inside the limits; returns n
        truth values. The search goes on within its bounds while all are refused.
    deadline: wall-clock time after which the search ends [s]; checked between its stages.
    task: what of the pose has to be reached; None: what the solver's options say.
    objective: what the answer is to be good at besides: an Objective, 'limits',
        'manipulability', or a function of joint values (dof,) that returns a cost. Comes before
        `near`. Of the answers found, the cheapest; a redundant arm's has slid to a local minimum.

Returns:
    A Result. A pose that cannot be solved is no error but a status.

Raises:
    InvalidArgumentError: wrong shape or dtype, a pose that is not rigid, a number that is not
        finite or out of range.)");
  cls.def("solve_all", &solve_all, py::arg("pose"), py::arg("max") = all.max, py::kw_only(),
          py::arg("min_distance") = all.min_distance, py::arg("whole_turns") = all.whole_turns,
          py::arg("order") = enum_name(all.order), py::arg("near") = py::none(),
          py::arg("weights") = py::none(), py::arg("norm") = norm, py::arg("seeds") = py::none(),
          py::arg("database_seeds") = wishes.database_seeds, py::arg("filter") = py::none(),
          py::arg("deadline") = py::none(), py::arg("task") = py::none(),
          R"(Every distinct solution that is found: all branches, or a spread for a redundant arm.

Args:
    pose: T_base_tip [m], as in solve.
    max: solutions given at most.
    min_distance: solutions that differ by less in every joint are one [rad or m].
    whole_turns: whether copies by whole turns inside the limits count as solutions of their own;
        otherwise each comes once, at the turn nearest to `near` or to the middle of the limits.
    order: what comes first.
    near, weights, norm, seeds, database_seeds, filter, deadline, task: as in solve.

Returns:
    Solutions; empty, with a status that says why, if there is none.

Raises:
    InvalidArgumentError: as solve.)");
  cls.def("diagnose", &diagnose, py::arg("pose"), py::kw_only(), py::arg("filter") = py::none(),
          py::arg("deadline") = py::none(), py::arg("task") = py::none(),
          R"(Why solve() with the same arguments gives no answer, and the best that can be done.

Spends much more than solving does, milliseconds to a second.

Args:
    pose: T_base_tip [m], as in solve.
    filter, deadline, task: as in solve.

Returns:
    A Diagnosis; its cause is `none` if there is an answer.

Raises:
    InvalidArgumentError: as solve.)");
}

}  // namespace iksel::python
