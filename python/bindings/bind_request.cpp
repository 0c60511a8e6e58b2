// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "gil.hpp"
#include "html.hpp"
#include "iksel/diagnosis.hpp"
#include "iksel/solver.hpp"
#include "pickle.hpp"
#include "pose_arguments.hpp"
#include "property.hpp"
#include "py_batch.hpp"
#include "py_result.hpp"
#include "python_types.hpp"
#include "request_keywords.hpp"

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

PyResult solve_plainly(const Solver& self, py::handle pose) {
  return {self.solve(as_pose(pose, "pose", &self.options().task)), {}};
}

py::object solve(const Solver& self, py::handle pose, const Given& given) {
  const SolveRequest request = read_request(self, given);
  const Pose target = as_pose(pose, "pose", &task_of(self, request));
  return py::cast(PyResult{without_gil([&] { return self.solve(target, request); }), {}});
}

py::object solve_all(const Solver& self, py::handle pose, const Given& given) {
  const int dof = self.robot().dof();
  const auto options = given.read<SolveAllOptions>(dof);
  const SolveRequest request = read_request(self, given);
  const Pose target = as_pose(pose, "pose", &task_of(self, request));
  return py::cast(
      PySolutions{without_gil([&] { return self.solve_all(target, options, request); }), dof});
}

py::object diagnose(const Solver& self, py::handle pose, const Given& given) {
  const SolveRequest request = read_request(self, given);
  const Pose target = as_pose(pose, "pose", &task_of(self, request));
  return py::cast(without_gil([&] { return self.diagnose(target, request); }));
}

py::object solutions_state(const PySolutions& self) {
  const Solutions& s = self.solutions;
  return py::make_tuple(enum_name(s.status), self.q(), self.column(&Result::position_error),
                        self.column(&Result::rotation_error), self.column(&Result::move),
                        self.column(&Result::cost), s.attempts, s.iterations, enum_name(s.proof));
}

PySolutions solutions_from_state(const py::object& state) {
  PickleState in(state, "Solutions", 9);
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
  out.proof = in.value<Proof>("proof");
  if (out.proof == (n > 0 ? Proof::none : Proof::answer)) {
    in.refuse("proof", "answer or more where solved, and only there", enum_name(out.proof));
  }
  for (py::ssize_t i = 0; i < n; ++i) {
    check_finite(q.data(i), dof, "pickled Solutions, q[" + std::to_string(i) + "]");
    if (!(position_error.at(i) >= 0 && rotation_error.at(i) >= 0)) {
      in.refuse("errors", "0 or more", "others");
    }
    Result& r = out.all.emplace_back();
    r.status = Status::solved;
    r.proof = Proof::answer;
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
  return "Solutions(" + status_text(self.solutions.status, self.solutions.proof) + ", " +
         std::to_string(all.size()) + " solutions" + best + ")";
}

std::string solutions_html(const PySolutions& self) {
  const auto& all = self.solutions.all;
  std::vector<std::string> header = {""};
  for (int i = 0; i < self.dof; ++i) header.push_back("q[" + std::to_string(i) + "]");
  header.insert(header.end(), {"position error [m]", "rotation error [rad]", "move"});
  HtmlTable table(std::to_string(all.size()) + " solutions, " +
                      status_text(self.solutions.status, self.solutions.proof),
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
  add_property(
      cls, "proof", [](const S& self) { return self.solutions.proof; },
      "How it is known that there is certainly no solution or, of a set that is not empty, that "
      "there are certainly no more; if it is not, `none` or `answer`.");
  add_property(
      cls, "proven", [](const S& self) { return is_proven(self.solutions.proof); },
      "Whether these are certainly all: `proof` is `reach`, `closed_form` or `target`.");
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
      cls, "cost", [](const S& self) { return self.column(&Result::cost); },
      "Costs by the objective, (n,); NaN without one.");
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
  {
    // The same method where no keyword is given, so that plain solving pays nothing for them. Of
    // the two, only the other has a docstring, and a name for the pose: pybind11 would make a
    // string of it at each call that has keywords.
    py::options options;
    options.disable_function_signatures();
    cls.def("solve", &solve_plainly);
  }
  def_method<0>(
      cls,
      {"solve",
       "Joint values that put the TCP (the tip link's frame, if there is no tool) at a pose.",
       "pose",
       "T_base_tip [m]: (4, 4) or (3, 4); a pair (position, rotation) with a (3, 3) "
       "matrix or a scipy Rotation; an object with as_matrix(), .homogeneous or .A "
       "(scipy, Pinocchio, spatialmath); (3,) if the task leaves the rotation free. One "
       "that is rounded stands for the nearest rigid one (see check_pose), by which the "
       "errors are measured.",
       "Result",
       R"(Returns:
    A Result. A pose that cannot be solved is no error but a status, and `proof` says how certain
    that is.

Raises:
    InvalidArgumentError: wrong shape or dtype, a pose that is not rigid, a number that is not
        finite or out of range.)"},
      request_keywords(),
      {"near", "weights", "norm", "seeds", "database_seeds", "scene", "exact", "filter", "deadline",
       "task", "objective", "closest"},
      &solve);
  def_method<1>(cls,
                {"solve_all",
                 "Every distinct solution that is found: all branches (there certainly are no "
                 "others where `proven` says so), or a spread for a redundant arm.",
                 "pose", "T_base_tip [m], as in solve.", "Solutions",
                 R"(Returns:
    Solutions; empty, with a status that says why, if there is none.

Raises:
    InvalidArgumentError: as solve.)"},
                solve_all_keywords(),
                {"max", "min_distance", "whole_turns", "order", "near", "weights", "norm", "seeds",
                 "database_seeds", "scene", "exact", "filter", "deadline", "task", "objective"},
                &solve_all);
  def_method<0>(
      cls,
      {"diagnose",
       "Why solve() with the same arguments gives no answer, and the best that can be done.\n\n"
       "Spends much more than solving does, milliseconds to a second.",
       "pose", "T_base_tip [m], as in solve.", "Diagnosis",
       R"(Returns:
    A Diagnosis; its cause is `none` if there is an answer.

Raises:
    InvalidArgumentError: as solve.)"},
      request_keywords(), {"scene", "exact", "filter", "deadline", "task"}, &diagnose);
}

}  // namespace iksel::python
