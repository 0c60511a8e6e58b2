// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <string>

#include "array_fields.hpp"
#include "bindings.hpp"
#include "html.hpp"
#include "property.hpp"
#include "py_batch.hpp"
#include "py_tree.hpp"

namespace iksel::python {

template <>
struct FromPython<std::vector<TreeResult>> : FromSequence<TreeResult> {};

namespace {

OptionalArray values_or_none(const double* values, py::ssize_t count) {
  return OptionalArray(count == 0 ? py::object(py::none())
                                  : py::object(py::array_t<double>(count, values)));
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

py::dict tree_result_state(const TreeResult& self) {
  return py::dict("status"_a = enum_name(self.status), "proof"_a = enum_name(self.proof),
                  "q"_a = to_array(self.q),
                  "position_error"_a = to_array(JointVector(self.position_error)),
                  "rotation_error"_a = to_array(JointVector(self.rotation_error)),
                  "move"_a = self.move, "unreachable_tip"_a = self.unreachable_tip,
                  "attempts"_a = self.attempts, "iterations"_a = self.iterations);
}

/// Errors of all tips, 0 or more.
void check_tips(const JointVector& errors) {
  if (errors.size() > kMaxTips || (errors.array() < 0).any()) {
    refuse_state("pickled TreeResult, errors",
                 "up to " + std::to_string(kMaxTips) + " numbers of 0 or more", "others");
  }
}

TreeResult tree_result_from_state(Status status, Proof proof, const JointVector& q,
                                  const JointVector& position_error,
                                  const JointVector& rotation_error, double move,
                                  int unreachable_tip, int attempts, int iterations) {
  const std::string of = "pickled TreeResult, ";
  check_tips(position_error);
  check_tips(rotation_error);
  may_be_length(move, of + "move");
  is_index<kMaxTips>(unreachable_tip, of + "unreachable_tip");
  is_count(attempts, of + "attempts");
  is_count(iterations, of + "iterations");
  TreeResult out;
  out.status = status;
  out.proof = proof;
  out.q = q;
  out.position_error = position_error;
  out.rotation_error = rotation_error;
  out.move = move;
  out.unreachable_tip = unreachable_tip;
  out.attempts = attempts;
  out.iterations = iterations;
  const bool has_q = out.q.size() > 0;
  if (has_q != out.success() || has_q != (out.position_error.size() > 0) ||
      out.position_error.size() != out.rotation_error.size()) {
    refuse_state(of + "q", "joint values and errors where solved, and only there", "others");
  }
  if (out.success() != (out.proof == Proof::answer) ||
      (out.success() && out.unreachable_tip >= 0)) {
    refuse_state(of + "proof", "answer where solved, and only there", enum_name(out.proof));
  }
  return out;
}

void bind_tree_single(py::module_& m) {
  using R = TreeResult;
  auto cls = bind_class<R>(m, "TreeResult",
                           "Answer to one target of each tip, true if it is one. Everything in it "
                           "is measured on the returned q.",
                           "TreeSolver.solve");
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
  def(cls, "__bool__", "", [](const R& self) { return self.success(); });
  def(cls, "__repr__", "", fn<&tree_result_repr>);
  def_pickle(cls, fn<&tree_result_state>,
             "status, proof, q, position_error, rotation_error, move, unreachable_tip, attempts, "
             "iterations",
             fn<&tree_result_from_state>);
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

py::dict tree_batch_state(const PyTreeBatch& self) {
  return py::dict("dof"_a = self.dof, "tips"_a = self.tips, "rows"_a = self.rows);
}

PyTreeBatch tree_batch_from_state(int dof, int tips, const std::vector<TreeResult>& rows) {
  const std::string of = "pickled TreeBatchResult, ";
  if (dof < 0 || dof > kMaxDof) refuse_state(of + "dof", "a number of joints", std::to_string(dof));
  if (tips < 0 || tips > kMaxTips) {
    refuse_state(of + "tips", "a number of tips", std::to_string(tips));
  }
  for (const TreeResult& row : rows) {
    if (row.success() && (row.q.size() != dof || row.position_error.size() != tips)) {
      refuse_state(of + "rows", "as many joints and tips in each", "others");
    }
  }
  return {rows, dof, tips};
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
  auto cls = bind_class<B>(m, "TreeBatchResult",
                           "Answers to many targets as arrays, each made when it is asked for; row "
                           "i belongs to target i. Indexing gives a TreeResult. It is neither true "
                           "nor false: ask success.all() or success.any().",
                           "TreeSolver.solve_batch");
  bind_tree_columns(cls);
  def(cls, "__len__", "", [](const B& self) { return self.rows.size(); });
  def(cls, "__getitem__", "i", [](const B& self, py::ssize_t i) {
    const auto rows = static_cast<py::ssize_t>(self.rows.size());
    return self.rows[static_cast<std::size_t>(as_row(i, rows, "row"))];
  });
  def_iter<TreeResult>(cls);
  def(cls, "__bool__", "", [](const B& self) -> bool {
    throw InvalidArgumentError("the truth of " + std::to_string(self.rows.size()) +
                               " answers is ambiguous: ask batch.success.all(), "
                               "batch.success.any(), or each TreeResult by itself");
  });
  def(cls, "__repr__", "", [](const B& self) {
    return "TreeBatchResult(" + std::to_string(count_solved(self)) + " of " +
           std::to_string(self.rows.size()) + " solved)";
  });
  def_pickle(cls, fn<&tree_batch_state>, "dof, tips, rows", fn<&tree_batch_from_state>);
}

}  // namespace

void bind_tree_result(py::module_& m) {
  bind_tree_single(m);
  bind_tree_rows(m);
}

}  // namespace iksel::python
