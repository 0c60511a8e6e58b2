// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "html.hpp"
#include "pickle.hpp"
#include "property.hpp"
#include "py_batch.hpp"

namespace iksel::python {

PyBatchResult PyBatchResult::rows(const RowsLike& index) const {
  py::object which = index;
  if (!py::isinstance<py::slice>(index)) {
    const auto array = py::array::ensure(index);
    const bool empty = array && array.size() == 0;
    const char kind = array ? array.dtype().kind() : '?';
    const bool is_tuple = py::isinstance<py::tuple>(index);  // numpy would ask for columns
    if (is_tuple || !array || array.ndim() != 1 ||
        (!empty && kind != 'b' && kind != 'i' && kind != 'u')) {
      throw_wrong_type("i", "an int, a slice, or (n,) ints or truth values", index);
    }
    which = empty && kind == 'f' ? array.attr("astype")("intp") : py::object(array);
  }
  const auto take = [&](const auto& array) {
    return std::decay_t<decltype(array)>(array.attr("__getitem__")(which).attr("copy")());
  };
  return {
      take(q),        take(success),    take(status), take(position_error), take(rotation_error),
      take(attempts), take(iterations), take(move),   take(proof)};
}

namespace {

std::string result_repr(const PyResult& self) {
  const Result& r = self.result;
  std::string text = "Result(" + status_text(r.status, r.proof);
  if (has_joints(r.status)) {
    text += ", q=" + short_numbers(r.q.data(), static_cast<std::size_t>(r.q.size())) +
            ", position_error=" + short_number(r.position_error, 3) +
            ", rotation_error=" + short_number(r.rotation_error, 3);
  }
  return text + ", attempts=" + std::to_string(r.attempts) +
         ", iterations=" + std::to_string(r.iterations) + ")";
}

std::string result_html(const PyResult& self) {
  const Result& r = self.result;
  HtmlTable table("Result", {"status", enum_name(r.status)});
  if (has_joints(r.status)) {
    table.add_row({"q", short_numbers(r.q.data(), static_cast<std::size_t>(r.q.size()))});
    table.add_row({"position error [m]", short_number(r.position_error, 3)});
    table.add_row({"rotation error [rad]", short_number(r.rotation_error, 3)});
  }
  if (!r.success()) table.add_row({"proof", enum_name(r.proof)});
  table.add_row({"attempts", std::to_string(r.attempts)});
  table.add_row({"iterations", std::to_string(r.iterations)});
  return table.text();
}

py::object result_state(PyResult& self) {
  const Result& r = self.result;
  return py::make_tuple(enum_name(r.status), self.joints(), r.position_error, r.rotation_error,
                        r.attempts, r.iterations, r.move, r.cost, enum_name(r.proof));
}

PyResult result_from_state(const py::object& state) {
  PickleState in(state, "Result", 9);
  Result r;
  r.status = in.value<Status>("status");
  const bool has_q = has_joints(r.status);
  if (has_q) {
    r.q = in.joints("q");
  } else if (!in.object().is_none()) {
    in.refuse("q", "None, as it is not solved", "joint values");
  }
  r.position_error = in.length("position_error", !has_q);
  r.rotation_error = in.length("rotation_error", !has_q);
  r.attempts = in.count("attempts");
  r.iterations = in.count("iterations");
  r.move = in.length("move", /*may_be_nan=*/true);
  r.cost = in.value<double>("cost");
  r.proof = in.value<Proof>("proof");
  if (r.success() != (r.proof == Proof::answer)) {
    in.refuse("proof", "answer where solved, and only there", enum_name(r.proof));
  }
  return {r, {}};
}

void bind_single(py::module_& m) {
  py::class_<PyResult> cls(m, "Result",
                           "Answer to one target, true if it is one. Everything in it is measured "
                           "on the returned q.");
  add_property(
      cls, "success", [](const PyResult& self) { return self.result.success(); },
      "Whether q reaches the target within both tolerances and lies inside the limits.");
  add_property(
      cls, "status", [](const PyResult& self) { return self.result.status; },
      "Why the solve ended.");
  add_property(
      cls, "proof", [](const PyResult& self) { return self.result.proof; },
      "`answer` of a success; of a failure, how certain it is that there is no answer.");
  add_property(
      cls, "proven", [](const PyResult& self) { return is_proven(self.result.proof); },
      "Whether there is certainly no answer: `proof` is `reach`, `closed_form` or `target`.");
  add_property(
      cls, "q", &PyResult::joints,
      "Joint values [rad or m], (dof,), read-only; None unless solved, or closest, for those who "
      "ask for it.");
  add_property(
      cls, "position_error", [](const PyResult& self) { return self.result.position_error; },
      "Distance to the target [m]; NaN without a q.");
  add_property(
      cls, "rotation_error", [](const PyResult& self) { return self.result.rotation_error; },
      "Length of the rotation vector to the target [rad]; NaN without a q.");
  add_property(
      cls, "move", [](const PyResult& self) { return self.result.move; },
      "Length of the move from `near`, by its norm and weights; NaN without one.");
  add_property(
      cls, "cost", [](const PyResult& self) { return self.result.cost; },
      "Cost of q by the objective; NaN without one.");
  add_property(
      cls, "attempts", [](const PyResult& self) { return self.result.attempts; }, "Seeds tried.");
  add_property(
      cls, "iterations", [](const PyResult& self) { return self.result.iterations; },
      "Iteration steps over all attempts.");
  cls.def("__bool__", [](const PyResult& self) { return self.result.success(); });
  cls.def("__repr__", &result_repr);
  cls.def("_repr_html_", &result_html);
  cls.def(py::pickle(&result_state, &result_from_state));
}

std::string batch_html(const PyBatchResult& self) {
  const auto text = [](double x) { return short_number(x, 3); };
  HtmlTable table(std::to_string(self.solved()) + " of " + std::to_string(self.size()) + " solved",
                  {"", "status", "proof", "q", "position error [m]", "rotation error [rad]",
                   "attempts", "iterations"});
  const auto rows = static_cast<std::size_t>(self.size());
  const std::size_t shown = std::min(rows, HtmlTable::kMostRows);
  for (std::size_t i = 0; i < shown; ++i) {
    const Result r = self.row(RowIndex(py::int_(i))).result;
    const bool has_q = has_joints(r.status);
    table.add_row({std::to_string(i), enum_name(r.status), r.success() ? "" : enum_name(r.proof),
                   has_q ? short_numbers(r.q.data(), static_cast<std::size_t>(r.q.size())) : "",
                   has_q ? text(r.position_error) : "", has_q ? text(r.rotation_error) : "",
                   std::to_string(r.attempts), std::to_string(r.iterations)});
  }
  table.add_rest(rows - shown);
  return table.text();
}

py::object batch_state(const PyBatchResult& self) {
  return py::make_tuple(self.q, self.success, self.status, self.position_error, self.rotation_error,
                        self.attempts, self.iterations, self.move, self.proof);
}

/// Statuses and proofs that there are, and numbers where there are answers.
void check_rows(const PyBatchResult& batch, const PickleState& in) {
  constexpr auto kStatuses = std::size(EnumTable<Status>::kValues);
  constexpr auto kProofs = std::size(EnumTable<Proof>::kValues);
  for (py::ssize_t i = 0; i < batch.size(); ++i) {
    const std::string row = "row " + std::to_string(i);
    if (batch.status.at(i) >= kStatuses) {
      in.refuse("status", "values of Status", std::to_string(batch.status.at(i)) + " in " + row);
    }
    if (batch.proof.at(i) >= kProofs) {
      in.refuse("proof", "values of Proof", std::to_string(batch.proof.at(i)) + " in " + row);
    }
    const auto status = static_cast<Status>(batch.status.at(i));
    const bool solved = status == Status::solved;
    const bool has_q = has_joints(status);
    if (batch.success.at(i) != solved) in.refuse("success", "the same as status says", row);
    if (solved != (static_cast<Proof>(batch.proof.at(i)) == Proof::answer)) {
      in.refuse("proof", "answer where solved, and only there", row);
    }
    if (has_q && !(batch.position_error.at(i) >= 0 && batch.rotation_error.at(i) >= 0)) {
      in.refuse("errors", "0 or more where there is a q", row);
    }
    if (has_q) check_finite(batch.q.data(i), static_cast<int>(batch.q.shape(1)), "q, " + row);
    if (batch.attempts.at(i) < 0 || batch.iterations.at(i) < 0) {
      in.refuse("attempts and iterations", "counts", row);
    }
  }
}

PyBatchResult batch_from_state(const py::object& state) {
  PickleState in(state, "BatchResult", 9);
  PyBatchResult batch;
  batch.q = in.rows("q");
  const py::ssize_t n = batch.q.shape(0);
  batch.success = in.column<bool>("success", n);
  batch.status = in.column<std::uint8_t>("status", n);
  batch.position_error = in.column<double>("position_error", n);
  batch.rotation_error = in.column<double>("rotation_error", n);
  batch.attempts = in.column<std::int32_t>("attempts", n);
  batch.iterations = in.column<std::int32_t>("iterations", n);
  batch.move = in.column<double>("move", n);
  batch.proof = in.column<std::uint8_t>("proof", n);
  check_rows(batch, in);
  return batch;
}

std::vector<Status> batch_statuses(const PyBatchResult& self) {
  std::vector<Status> statuses;
  statuses.reserve(static_cast<std::size_t>(self.size()));
  for (py::ssize_t i = 0; i < self.size(); ++i) {
    statuses.push_back(static_cast<Status>(self.status.at(i)));
  }
  return statuses;
}

void bind_batch(py::module_& m) {
  using B = PyBatchResult;
  py::class_<B> cls(m, "BatchResult",
                    "Answers to many targets as arrays; row i belongs to target i. Indexing gives "
                    "a Result, and by a slice or an array a BatchResult of its own. It is neither "
                    "true nor false: ask success.all() or success.any().");
  add_property(cls, "q", &B::q, "Joint values [rad or m], (N, dof); NaN where not solved.");
  add_property(cls, "success", &B::success, "Whether each target is solved, (N,).");
  add_property(cls, "status", &B::status, "Values of Status, (N,).");
  add_property(cls, "proof", &B::proof, "Values of Proof, (N,); that of `answer` where solved.");
  add_property(cls, "position_error", &B::position_error,
               "Distances to the targets [m], (N,); NaN where not solved.");
  add_property(cls, "rotation_error", &B::rotation_error,
               "Lengths of the rotation vectors to the targets [rad], (N,); NaN where not "
               "solved.");
  add_property(cls, "attempts", &B::attempts, "Seeds tried, (N,).");
  add_property(cls, "iterations", &B::iterations, "Iteration steps over all attempts, (N,).");
  add_property(cls, "move", &B::move,
               "Lengths of the moves from `near`, (N,); NaN where not solved or without one.");
  add_property(cls, "solved", &B::solved, "Number of targets solved.");
  cls.def("statuses", &batch_statuses, "`status` as members of Status.");
  cls.def("__len__", &B::size);
  cls.def("__getitem__", &B::row, py::arg("i"));
  cls.def("__getitem__", &B::rows, py::arg("i"));
  cls.def("__iter__", &iterate_rows);
  cls.def("__bool__", [](const B& self) -> bool {
    throw InvalidArgumentError("the truth of " + std::to_string(self.size()) +
                               " answers is ambiguous: ask batch.success.all(), "
                               "batch.success.any(), or each Result by itself");
  });
  cls.def("__repr__", [](const B& self) {
    return "BatchResult(" + std::to_string(self.solved()) + " of " + std::to_string(self.size()) +
           " solved)";
  });
  cls.def("_repr_html_", &batch_html);
  cls.def(py::pickle(&batch_state, &batch_from_state));
}

}  // namespace

void bind_result(py::module_& m) {
  bind_enum<Status>(m);
  bind_enum<Proof>(m);
  bind_single(m);
  bind_batch(m);
}

}  // namespace iksel::python
