// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "html.hpp"
#include "result_fields.hpp"

namespace iksel::python {

PyBatchResult PyBatchResult::rows(py::handle index) const {
  py::object which = py::reinterpret_borrow<py::object>(index);
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

void FieldTable<PyBatchResult>::check(const B& batch) {
  constexpr auto kStatuses = std::size(EnumTable<Status>::kValues);
  constexpr auto kProofs = std::size(EnumTable<Proof>::kValues);
  const py::ssize_t n = batch.q.ndim() == 2 ? batch.q.shape(0) : -1;
  if (n < 0 || batch.q.shape(1) > kMaxDof) {
    throw_wrong_shape("pickled BatchResult, q", "an (n, dof) array", batch.q);
  }
  const auto is_column = [&](const char* name, const py::array& array) {
    if (array.ndim() == 1 && array.shape(0) == n) return;
    throw_wrong_shape(name, "a (" + std::to_string(n) + ",) array", array);
  };
  is_column("pickled BatchResult, success", batch.success);
  is_column("pickled BatchResult, status", batch.status);
  is_column("pickled BatchResult, proof", batch.proof);
  is_column("pickled BatchResult, position_error", batch.position_error);
  is_column("pickled BatchResult, rotation_error", batch.rotation_error);
  is_column("pickled BatchResult, attempts", batch.attempts);
  is_column("pickled BatchResult, iterations", batch.iterations);
  is_column("pickled BatchResult, move", batch.move);
  for (py::ssize_t i = 0; i < batch.size(); ++i) {
    const std::string row = "row " + std::to_string(i);
    if (batch.status.at(i) >= kStatuses) {
      refuse_state("pickled BatchResult, status", "values of Status",
                   std::to_string(batch.status.at(i)) + " in " + row);
    }
    if (batch.proof.at(i) >= kProofs) {
      refuse_state("pickled BatchResult, proof", "values of Proof",
                   std::to_string(batch.proof.at(i)) + " in " + row);
    }
    const auto status = static_cast<Status>(batch.status.at(i));
    const bool solved = status == Status::solved;
    const bool has_q = has_joints(status);
    if (batch.success.at(i) != solved)
      refuse_state("pickled BatchResult, success", "the same as status says", row);
    if (solved != (static_cast<Proof>(batch.proof.at(i)) == Proof::answer)) {
      refuse_state("pickled BatchResult, proof", "answer where solved, and only there", row);
    }
    if (has_q && !(batch.position_error.at(i) >= 0 && batch.rotation_error.at(i) >= 0)) {
      refuse_state("pickled BatchResult, errors", "0 or more where there is a q", row);
    }
    if (has_q)
      check_finite(batch.q.data(i), static_cast<int>(batch.q.shape(1)),
                   "pickled BatchResult, q, " + row);
    if (batch.attempts.at(i) < 0 || batch.iterations.at(i) < 0) {
      refuse_state("pickled BatchResult, attempts and iterations", "counts", row);
    }
  }
}

namespace {

std::string result_repr(const PyResult& self) {
  const Result& r = self;
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
  const Result& r = self;
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

std::string batch_html(const PyBatchResult& self) {
  const auto text = [](double x) { return short_number(x, 3); };
  HtmlTable table(std::to_string(self.solved()) + " of " + std::to_string(self.size()) + " solved",
                  {"", "status", "proof", "q", "position error [m]", "rotation error [rad]",
                   "attempts", "iterations"});
  const auto rows = static_cast<std::size_t>(self.size());
  const std::size_t shown = std::min(rows, HtmlTable::kMostRows);
  for (std::size_t i = 0; i < shown; ++i) {
    const Result r = self.row(static_cast<py::ssize_t>(i));
    const bool has_q = has_joints(r.status);
    table.add_row({std::to_string(i), enum_name(r.status), r.success() ? "" : enum_name(r.proof),
                   has_q ? short_numbers(r.q.data(), static_cast<std::size_t>(r.q.size())) : "",
                   has_q ? text(r.position_error) : "", has_q ? text(r.rotation_error) : "",
                   std::to_string(r.attempts), std::to_string(r.iterations)});
  }
  table.add_rest(rows - shown);
  return table.text();
}

std::vector<Status> batch_statuses(const PyBatchResult& self) {
  std::vector<Status> statuses;
  statuses.reserve(static_cast<std::size_t>(self.size()));
  for (py::ssize_t i = 0; i < self.size(); ++i) {
    statuses.push_back(static_cast<Status>(self.status.at(i)));
  }
  return statuses;
}

std::string batch_repr(const PyBatchResult& self) {
  return "BatchResult(" + std::to_string(self.solved()) + " of " + std::to_string(self.size()) +
         " solved)";
}

bool refuse_truth(const PyBatchResult& self) {
  throw InvalidArgumentError("the truth of " + std::to_string(self.size()) +
                             " answers is ambiguous: ask batch.success.all(), "
                             "batch.success.any(), or each Result by itself");
}

py::object row_or_rows(const PyBatchResult& self, const py::object& i) {
  if (is_row_number(i)) return py::cast(self.row(from_python<py::ssize_t>(i, "i")));
  return py::cast(self.rows(i));
}

void bind_single(py::module_& m) {
  auto cls = bind_fields<PyResult>(m, "Solver.solve");
  add_property(
      cls, "success", [](const PyResult& self) { return self.success(); },
      "Whether q reaches the target within both tolerances and lies inside the limits.");
  add_property(
      cls, "unreachable_tip",
      [](const PyResult& self) { return optional_index(self.unreachable_tip); },
      "Of a failure with several tips: one whose target its chain cannot reach by itself, as far "
      "as "
      "a search can tell, and status and proof are that chain's; None: each can, or none was "
      "looked "
      "at.");
  add_property(
      cls, "proven", [](const PyResult& self) { return is_proven(self.proof); },
      "Whether there is certainly no answer: `proof` is `reach`, `closed_form` or `target`.");
  add_property(
      cls, "q", &PyResult::joints,
      "Joint values [rad or m], (dof,), read-only; None unless solved, or closest, for those who "
      "ask for it.");
  def(cls, "__bool__", "", [](const PyResult& self) { return self.success(); });
  def(cls, "__repr__", "", fn<&result_repr>);
  def(cls, "_repr_html_", "", fn<&result_html>);
}

void bind_batch(py::module_& m) {
  using B = PyBatchResult;
  auto cls = bind_fields<B>(m, "Solver.solve_batch");
  add_property(cls, "solved", &B::solved, "Number of targets solved.");
  def(cls, "statuses", "", fn<&batch_statuses>, "`status` as members of Status.");
  def(cls, "__len__", "", fn<&B::size>);
  def_getitem(cls, fn<&row_or_rows>,
              {"int) -> iksel_cpp.Result",
               "slice | collections.abc.Sequence[int] | "
               "numpy.typing.NDArray[numpy.integer[typing.Any] | numpy.bool_]) -> "
               "iksel_cpp.BatchResult"});
  def_iter<PyResult>(cls);
  def(cls, "__bool__", "", fn<&refuse_truth>);
  def(cls, "__repr__", "", fn<&batch_repr>);
  def(cls, "_repr_html_", "", fn<&batch_html>);
}

}  // namespace

void bind_result(py::module_& m) {
  bind_enum<Status>(m);
  bind_enum<Proof>(m);
  bind_single(m);
  bind_batch(m);
}

}  // namespace iksel::python
