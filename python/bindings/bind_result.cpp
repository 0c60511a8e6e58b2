// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "scene_types.hpp"

namespace iksel::python {

template <>
struct FieldTable<Diagnosis> : HeaderTable<Diagnosis> {
  using D = Diagnosis;
  static std::vector<Field> fields() {
    return HeaderFields<D>()
        .hide({"unreachable_tip"})
        .check<&may_be_length>({"beyond_reach", "rotation_gap", "limit_violation",
                                "least_singular_value", "position_error", "rotation_error"})
        .check<&is_index<kMaxDof>>({"joint"})
        .check<&is_index<kMaxCoupledLimits>>({"coupled_limit"})
        .check<&is_index<kMaxTips>>({"unreachable_tip"})
        .check<&is_count>({"refused", "attempts"})
        .all();
  }
  static void check(const D& self) {
    const std::string of = "pickled Diagnosis, ";
    if (self.branch.size() != 0 && self.branch.size() != self.q.size()) {
      refuse_state(of + "branch", "as many joints as q, or none",
                   std::to_string(self.branch.size()));
    }
    if (self.q_is_solution != (self.proof == Proof::answer)) {
      refuse_state(of + "proof", "answer where there is one, and only there",
                   enum_name(self.proof));
    }
    if (self.joint >= self.q.size()) {
      refuse_state(of + "joint", "one of q's", std::to_string(self.joint));
    }
    if (self.q_is_solution && (self.q.size() == 0 || !(self.position_error >= 0))) {
      refuse_state(of + "q_is_solution", "False without joint values and errors", "True");
    }
  }
};

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
  PyBatchResult out;
  for (const Field& column : struct_type<PyBatchResult>().fields) {
    const auto& array = as<py::object>(column.of(this));
    *static_cast<py::object*>(column.of(&out)) = array.attr("__getitem__")(which).attr("copy")();
  }
  return out;
}

std::vector<Field> FieldTable<PyBatchResult>::fields() {
  return HeaderFields<B, void>()
      .add("q", &B::q, header_text("BatchView.q"))
      .add("success", &B::success, "Whether each target is solved, (n,).")
      .add("status", &B::status, header_text("BatchView.status"))
      .add("proof", &B::proof, header_text("BatchView.proof"))
      .add("position_error", &B::position_error, header_text("BatchView.position_error"))
      .add("rotation_error", &B::rotation_error, header_text("BatchView.rotation_error"))
      .add("attempts", &B::attempts, header_text("BatchView.attempts"))
      .add("iterations", &B::iterations, header_text("BatchView.iterations"))
      .add("move", &B::move, header_text("BatchView.move"))
      .add("unreachable_tip", &B::unreachable_tip, header_text("BatchView.unreachable_tip"))
      .all();
}

void FieldTable<PyBatchResult>::check(const B& batch) {
  constexpr auto kStatuses = std::size(EnumTable<Status>::kValues);
  constexpr auto kProofs = std::size(EnumTable<Proof>::kValues);
  const py::ssize_t n = batch.q.ndim() == 2 ? batch.q.shape(0) : -1;
  if (n < 0 || batch.q.shape(1) > kMaxDof) {
    throw_wrong_shape("pickled BatchResult, q", "an (n, dof) array", batch.q);
  }
  const std::string of = "pickled BatchResult, ";
  for (const Field& column : struct_type<B>().fields) {
    const auto& array = as<py::array>(column.of(&batch));
    if (&array == &batch.q || (array.ndim() == 1 && array.shape(0) == n)) continue;
    const std::string name = of + column.name;
    throw_wrong_shape(name.c_str(), "a (" + std::to_string(n) + ",) array", array);
  }
  for (py::ssize_t i = 0; i < n; ++i) {
    const auto require = [&](bool holds, const char* field, const char* expected, int got = -1) {
      if (holds) return;
      const std::string value = got < 0 ? "another" : std::to_string(got);
      refuse_state(of + field, expected, value + " in row " + std::to_string(i));
    };
    require(batch.status.at(i) < kStatuses, "status", "values of Status", batch.status.at(i));
    require(batch.proof.at(i) < kProofs, "proof", "values of Proof", batch.proof.at(i));
    const auto status = static_cast<Status>(batch.status.at(i));
    const bool solved = status == Status::solved;
    const bool has_q = has_joints(status);
    const bool has_answer = static_cast<Proof>(batch.proof.at(i)) == Proof::answer;
    require(batch.success.at(i) == solved, "success", "the same as status says");
    require(solved == has_answer, "proof", "answer where solved, and only there");
    require(!has_q || (batch.position_error.at(i) >= 0 && batch.rotation_error.at(i) >= 0),
            "errors", "0 or more where there is a q");
    require(batch.attempts.at(i) >= 0 && batch.iterations.at(i) >= 0, "attempts and iterations",
            "counts");
    is_index<kMaxTips>(batch.unreachable_tip.at(i), of + "unreachable_tip");
    const auto dof = static_cast<int>(batch.q.shape(1));
    if (has_q) check_finite(batch.q.data(i), dof, of + "q, row " + std::to_string(i));
  }
}

namespace {

std::vector<Status> batch_statuses(const PyBatchResult& self) {
  std::vector<Status> statuses(static_cast<std::size_t>(self.size()));
  std::transform(self.status.data(), self.status.data() + self.size(), statuses.begin(),
                 [](std::uint8_t status) { return static_cast<Status>(status); });
  return statuses;
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
  def_success(cls);
  add_property(cls, "unreachable_tip",
               [](const PyResult& self) { return optional_index(self.unreachable_tip); });
  def_proven(cls);
  add_property(cls, "q", &PyResult::joints);
  def_page(cls);
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
  def_page(cls);
}

}  // namespace

void bind_result(py::module_& m) {
  bind_enums<Status, Proof>(m);
  bind_single(m);
  bind_batch(m);
}

void bind_diagnosis(py::module_& m) {
  bind_enums<Cause>(m);
  auto cls = bind_fields<Diagnosis>(m, "Solver.diagnose");
  def_proven(cls);
  add_property(cls, "unreachable_tip",
               [](const Diagnosis& self) { return optional_index(self.unreachable_tip); });
  def(cls, "__bool__", "", [](const Diagnosis& self) { return self.q_is_solution; });
}

}  // namespace iksel::python
