// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "keywords.hpp"

namespace iksel::python {

/// The distinct solutions for one target.
struct PySolutions : Solutions {
  int dof = 0;

  [[nodiscard]] py::ssize_t size() const { return static_cast<py::ssize_t>(all.size()); }

  [[nodiscard]] py::array_t<double> q() const {
    std::vector<JointVector> rows;
    for (const Result& each : all) rows.push_back(each.q);
    return stack_joints(rows, dof);
  }

  template <double Result::*kMember>
  [[nodiscard]] py::array_t<double> column() const {
    py::array_t<double> array(size());
    double* out = array.mutable_data();
    for (const Result& result : all) *out++ = result.*kMember;
    return array;
  }

  [[nodiscard]] PyResult row(py::ssize_t i) const {
    return PyResult(all[static_cast<std::size_t>(as_row(i, size(), "solution"))]);
  }
};

/// In pickles, a list of Result.
template <>
struct FromPython<std::vector<Result>> {
  static std::string text() { return "list[iksel_cpp.Result]"; }
  static std::vector<Result> convert(py::handle value, const char* name) {
    const auto all = FromSequence<PyResult>::convert(value, name);
    return {all.begin(), all.end()};
  }
  static std::vector<PyResult> show(const std::vector<Result>& all) {
    return {all.begin(), all.end()};
  }
};

template <>
struct FieldTable<PySolutions> : HeaderTable<PySolutions, Solutions> {
  using S = PySolutions;
  static std::vector<Field> fields() {
    return HeaderFields<S, Solutions>()
        .hide({"all"})
        .check<&is_count>({"attempts", "iterations"})
        .add("dof", &S::dof)
        .all();
  }
  static void check(const S& self) {
    const std::string of = "pickled Solutions, ";
    if (self.success() == self.all.empty()) {
      refuse_state(of + "all", "solutions where solved, and only there", "others");
    }
    if (self.proof == (self.success() ? Proof::none : Proof::answer)) {
      refuse_state(of + "proof", "answer or more where solved, and only there",
                   enum_name(self.proof));
    }
    const bool fits = std::all_of(self.all.begin(), self.all.end(), [&](const Result& each) {
      return each.success() && each.q.size() == self.dof;
    });
    if (!fits || self.dof < 0 || self.dof > kMaxDof) {
      refuse_state(of + "dof", "the number of joints of all", std::to_string(self.dof));
    }
  }
};

namespace {

PyResult solve(const Solver& self, py::handle pose, const Given& given) {
  const bool has_one_tip = self.robot().tips() == 1;
  if (given.is_empty() && has_one_tip) {
    return PyResult(self.solve(as_pose(pose, "pose", &self.options().task)));
  }
  const SolveRequest request = read_request(self, given);
  if (has_one_tip) {
    const Pose target = as_pose(pose, "pose", &task_of(self, request));
    return PyResult(without_gil([&] { return self.solve(target, request); }));
  }
  const std::vector<Pose> targets = as_targets(self, pose, request);
  return PyResult(without_gil([&] { return self.solve(targets, request); }));
}

PySolutions solve_all(const Solver& self, py::handle pose, const Given& given) {
  const int dof = self.robot().dof();
  const auto options = given.read<SolveAllOptions>(dof);
  const SolveRequest request = read_request(self, given);
  const std::vector<Pose> targets = as_targets(self, pose, request);
  return {without_gil([&] { return self.solve_all(targets, options, request); }), dof};
}

Diagnosis diagnose(const Solver& self, py::handle pose, const Given& given) {
  const SolveRequest request = read_request(self, given);
  const std::vector<Pose> targets = as_targets(self, pose, request);
  return without_gil([&] { return self.diagnose(targets, request); });
}

void bind_solutions(py::module_& m) {
  using S = PySolutions;
  auto cls = bind_fields<S>(m, "Solver.solve_all");
  def_success(cls);
  def_proven(cls, "these are certainly all");
  add_property(cls, "q", &S::q, "Joint values [rad or m], (n, dof).");
  add_property(cls, "position_error", &S::column<&Result::position_error>,
               "Distances to the target [m], (n,).");
  add_property(cls, "rotation_error", &S::column<&Result::rotation_error>,
               "Lengths of the rotation vectors to the target [rad], (n,).");
  add_property(cls, "move", &S::column<&Result::move>,
               "Lengths of the moves from `near`, (n,); NaN without one.");
  add_property(cls, "cost", &S::column<&Result::cost>,
               "Costs by the objective, (n,); NaN without one.");
  def(cls, "__len__", "", fn<&S::size>);
  def(cls, "__getitem__", "i", fn<&S::row>);
  def_iter<PyResult>(cls);
  def_page(cls);
}

}  // namespace

void bind_requests(py::module_& m, py::class_<Solver>& cls) {
  bind_solutions(m);
  def_method<SolveRequest>(
      cls,
      {"solve",
       "Joint values that put the TCP (the tip link's frame, if there is no tool) at a pose, or "
       "the TCP of each tip at its own.",
       "pose",
       "T_base_tip [m]: (4, 4) or (3, 4); a pair (position, rotation) with a (3, 3) matrix or a "
       "scipy Rotation; an object with as_matrix(), .homogeneous or .A (scipy, Pinocchio, "
       "spatialmath); (3,) if the task leaves the rotation free. One that is rounded stands for "
       "the nearest rigid one (see check_pose), by which the errors are measured. Of several "
       "tips, (k, 4, 4) or k of these.",
       R"(Returns:
    A Result. A pose that cannot be solved is no error but a status, and `proof` says how certain
    that is.

Raises:
    InvalidArgumentError: wrong shape or dtype, a pose that is not rigid, a number that is not
        finite or out of range.)"},
      0,
      {"near", "weights", "norm", "seeds", "database_seeds", "scene", "exact", "filter", "deadline",
       "task", "objective", "closest", "prove", "tasks", "in_frame_of"},
      fn<&solve>);
  def_method<SolveAllOptions, SolveRequest>(
      cls,
      {"solve_all",
       "Every distinct solution that is found: all branches (there certainly are no others where "
       "`proven` says so), or a spread for a redundant arm.",
       "pose", "T_base_tip [m], as in solve.",
       R"(Returns:
    Solutions; empty, with a status that says why, if there is none.

Raises:
    InvalidArgumentError: as solve.)"},
      1,
      {"max", "min_distance", "whole_turns", "order", "near", "weights", "norm", "seeds",
       "database_seeds", "scene", "exact", "filter", "deadline", "task", "objective", "prove",
       "tasks", "in_frame_of"},
      fn<&solve_all>);
  def_method<SolveRequest>(
      cls,
      {"diagnose",
       "Why solve() with the same arguments gives no answer, and the best that can be done.\n\n"
       "Spends much more than solving does, milliseconds to a second.",
       "pose", "T_base_tip [m], as in solve.",
       R"(Returns:
    A Diagnosis; its cause is `none` if there is an answer.

Raises:
    InvalidArgumentError: as solve.)"},
      0, {"scene", "exact", "filter", "deadline", "task", "tasks", "in_frame_of"}, fn<&diagnose>);
}

}  // namespace iksel::python
