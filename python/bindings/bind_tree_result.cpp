// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <string>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "html.hpp"
#include "pickle.hpp"
#include "property.hpp"
#include "py_batch.hpp"
#include "py_tree.hpp"

namespace iksel::python {

namespace {

OptionalJoints values_or_none(const double* values, py::ssize_t count) {
  const py::object value =
      count == 0 ? py::object(py::none()) : py::object(py::array_t<double>(count, values));
  return py::reinterpret_borrow<OptionalJoints>(value);
}

std::string tree_result_repr(const TreeResult& self) {
  std::string text = "TreeResult(" + status_text(self.status, self.proof);
  if (self.success()) {
    text += ", q=" + short_numbers(self.q.data(), static_cast<std::size_t>(self.q.size()));
  } else if (self.unreachable_tip >= 0) {
    text += ", unreachable_tip=" + std::to_string(self.unreachable_tip);
  }
  return text + ", attempts=" + std::to_string(self.attempts) +
         ", iterations=" + std::to_string(self.iterations) + ")";
}

py::object tree_result_state(const TreeResult& self) {
  return py::make_tuple(enum_name(self.status), enum_name(self.proof), to_array(self.q),
                        to_array(JointVector(self.position_error)),
                        to_array(JointVector(self.rotation_error)), self.move, self.unreachable_tip,
                        self.attempts, self.iterations);
}

/// Errors of all tips, 0 or more.
TipVector errors_from(PickleState& in, const char* item) {
  const JointVector errors = in.joints(item);
  if (errors.size() > kMaxTips || (errors.array() < 0).any()) {
    in.refuse(item, "up to " + std::to_string(kMaxTips) + " numbers of 0 or more", "others");
  }
  return errors;
}

TreeResult tree_result_from_state(const py::object& state) {
  PickleState in(state, "TreeResult", 9);
  TreeResult out;
  out.status = in.value<Status>("status");
  out.proof = in.value<Proof>("proof");
  out.q = in.joints("q");
  out.position_error = errors_from(in, "position_error");
  out.rotation_error = errors_from(in, "rotation_error");
  out.move = in.length("move", /*may_be_nan=*/true);
  out.unreachable_tip = in.index<int>("unreachable_tip", kMaxTips);
  out.attempts = in.count("attempts");
  out.iterations = in.count("iterations");
  const bool has_q = out.q.size() > 0;
  if (has_q != out.success() || has_q != (out.position_error.size() > 0) ||
      out.position_error.size() != out.rotation_error.size()) {
    in.refuse("q", "joint values and errors where solved, and only there", "others");
  }
  if (out.success() != (out.proof == Proof::answer) ||
      (out.success() && out.unreachable_tip >= 0)) {
    in.refuse("proof", "answer where solved, and only there", enum_name(out.proof));
  }
  return out;
}

void bind_tree_single(py::module_& m) {
  using R = TreeResult;
  py::class_<R> cls(m, "TreeResult",
                    "Answer to one target of each tip, true if it is one. Everything in it is "
                    "measured on the returned q.");
  add_property(
      cls, "success", [](const R& self) { return self.success(); },
      "Whether q puts each tip at its target within both tolerances and lies inside the limits.");
  add_property(cls, "status", &R::status,
               "Why the solve ended; of a failure, that of the tip that cannot be reached even by "
               "itself, if one was found.");
  add_property(cls, "proof", &R::proof,
               "`answer` of a success; of a failure, how certain it is that there is no answer.");
  add_property(
      cls, "proven", [](const R& self) { return is_proven(self.proof); },
      "Whether there is certainly no answer: `proof` is `reach` or `closed_form`.");
  add_property(
      cls, "q", [](const R& self) { return values_or_none(self.q.data(), self.q.size()); },
      "Joint values [rad or m], (dof,); None unless solved.");
  add_property(
      cls, "position_error",
      [](const R& self) {
        return values_or_none(self.position_error.data(), self.position_error.size());
      },
      "Distance of each tip to its target [m], (k,); None unless solved.");
  add_property(
      cls, "rotation_error",
      [](const R& self) {
        return values_or_none(self.rotation_error.data(), self.rotation_error.size());
      },
      "Length of each tip's rotation vector to its target [rad], (k,); None unless solved.");
  add_property(cls, "move", &R::move,
               "Length of the move from `near`, by its norm and weights; NaN without one.");
  add_property(
      cls, "unreachable_tip", [](const R& self) { return tip_or_none(self.unreachable_tip); },
      "Of a failure, index of a tip whose target its chain cannot reach by itself; None if each "
      "can as far as a search can tell, or it was not looked for.");
  add_property(cls, "attempts", &R::attempts,
               "Values of the shared joints and seeds that were tried.");
  add_property(cls, "iterations", &R::iterations, "Iteration steps on all tips together.");
  cls.def("__bool__", [](const R& self) { return self.success(); });
  cls.def("__repr__", &tree_result_repr);
  cls.def(py::pickle(&tree_result_state, &tree_result_from_state));
}

/// (N,) of a number of each row.
template <class T, class Get>
py::array_t<T> tree_column(const PyTreeBatch& self, const Get& get) {
  py::array_t<T> array(static_cast<py::ssize_t>(self.rows.size()));
  std::transform(self.rows.begin(), self.rows.end(), array.mutable_data(), get);
  return array;
}

/// (N, width) of the values of each row, NaN where there are none.
template <class Get>
py::array_t<double> tree_table(const PyTreeBatch& self, int width, const Get& get) {
  py::array_t<double> array({static_cast<py::ssize_t>(self.rows.size()), py::ssize_t{width}});
  double* out = array.mutable_data();
  for (const TreeResult& row : self.rows) {
    const auto& values = get(row);
    if (values.size() == width) {
      out = std::copy_n(values.data(), width, out);
    } else {
      out = std::fill_n(out, width, std::numeric_limits<double>::quiet_NaN());
    }
  }
  return array;
}

py::ssize_t count_solved(const PyTreeBatch& self) {
  return std::count_if(self.rows.begin(), self.rows.end(),
                       [](const TreeResult& row) { return row.success(); });
}

py::object tree_batch_state(const PyTreeBatch& self) {
  return py::make_tuple(self.dof, self.tips, py::cast(self.rows));
}

PyTreeBatch tree_batch_from_state(const py::object& state) {
  PickleState in(state, "TreeBatchResult", 3);
  PyTreeBatch out;
  out.dof = in.count("dof");
  out.tips = in.count("tips");
  if (out.dof > kMaxDof) in.refuse("dof", "a number of joints", std::to_string(out.dof));
  if (out.tips > kMaxTips) in.refuse("tips", "a number of tips", std::to_string(out.tips));
  for (const py::handle row : in.list("rows")) {
    if (!py::isinstance<TreeResult>(row)) {
      in.refuse("rows", "TreeResults", py::cast<std::string>(py::repr(row)));
    }
    out.rows.push_back(py::cast<TreeResult>(row));
    const TreeResult& last = out.rows.back();
    if (last.success() && (last.q.size() != out.dof || last.position_error.size() != out.tips)) {
      in.refuse("rows", "as many joints and tips in each", "others");
    }
  }
  return out;
}

void bind_tree_columns(py::class_<PyTreeBatch>& cls) {
  using B = PyTreeBatch;
  using R = TreeResult;
  add_property(
      cls, "q",
      [](const B& self) {
        return tree_table(
            self, self.dof, [](const R& r) -> const auto& { return r.q; });
      },
      "Joint values [rad or m], (N, dof); NaN where not solved.");
  add_property(
      cls, "success",
      [](const B& self) { return tree_column<bool>(self, [](const R& r) { return r.success(); }); },
      "Whether each target is solved, (N,).");
  add_property(
      cls, "status",
      [](const B& self) {
        return tree_column<std::uint8_t>(
            self, [](const R& r) { return static_cast<std::uint8_t>(r.status); });
      },
      "Values of Status, (N,).");
  add_property(
      cls, "position_error",
      [](const B& self) {
        return tree_table(
            self, self.tips, [](const R& r) -> const auto& { return r.position_error; });
      },
      "Distance of each tip to its target [m], (N, k); NaN where not solved.");
  add_property(
      cls, "rotation_error",
      [](const B& self) {
        return tree_table(
            self, self.tips, [](const R& r) -> const auto& { return r.rotation_error; });
      },
      "Length of each tip's rotation vector to its target [rad], (N, k); NaN where not solved.");
  add_property(
      cls, "move",
      [](const B& self) { return tree_column<double>(self, [](const R& r) { return r.move; }); },
      "Lengths of the moves from `near`, (N,); NaN where not solved or without one.");
  add_property(
      cls, "unreachable_tip",
      [](const B& self) {
        return tree_column<std::int32_t>(self, [](const R& r) { return r.unreachable_tip; });
      },
      "As TreeResult.unreachable_tip, (N,); -1: none.");
  add_property(
      cls, "attempts",
      [](const B& self) {
        return tree_column<std::int32_t>(self, [](const R& r) { return r.attempts; });
      },
      "Values of the shared joints and seeds that were tried, (N,).");
  add_property(cls, "solved", &count_solved, "Number of targets solved.");
}

void bind_tree_rows(py::module_& m) {
  using B = PyTreeBatch;
  py::class_<B> cls(m, "TreeBatchResult",
                    "Answers to many targets as arrays, each made when it is asked for; row i "
                    "belongs to target i. Indexing gives a TreeResult. It is neither true nor "
                    "false: ask success.all() or success.any().");
  bind_tree_columns(cls);
  cls.def("__len__", [](const B& self) { return self.rows.size(); });
  cls.def(
      "__getitem__",
      [](const B& self, const RowIndex& i) {
        const auto rows = static_cast<py::ssize_t>(self.rows.size());
        return self.rows[static_cast<std::size_t>(as_row(i, rows, "row"))];
      },
      py::arg("i"));
  cls.def("__iter__", [](const py::object& self) {
    return py::reinterpret_steal<py::typing::Iterator<TreeResult>>(PySeqIter_New(self.ptr()));
  });
  cls.def("__bool__", [](const B& self) -> bool {
    throw InvalidArgumentError("the truth of " + std::to_string(self.rows.size()) +
                               " answers is ambiguous: ask batch.success.all(), "
                               "batch.success.any(), or each TreeResult by itself");
  });
  cls.def("__repr__", [](const B& self) {
    return "TreeBatchResult(" + std::to_string(count_solved(self)) + " of " +
           std::to_string(self.rows.size()) + " solved)";
  });
  cls.def(py::pickle(&tree_batch_state, &tree_batch_from_state));
}

}  // namespace

void bind_tree_result(py::module_& m) {
  bind_tree_single(m);
  bind_tree_rows(m);
}

}  // namespace iksel::python
