// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include "array_fields.hpp"
#include "bindings.hpp"
#include "iksel/tree_solver.hpp"
#include "py_tree.hpp"
#include "sequence_of.hpp"

namespace iksel::python {

template <>
struct FromPython<std::vector<Diagnosis>> : FromSequence<Diagnosis> {};

namespace {

py::dict tree_diagnosis_state(const TreeDiagnosis& self) {
  return py::dict("tips"_a = self.tips, "unreachable_tip"_a = self.unreachable_tip,
                  "message"_a = self.message);
}

TreeDiagnosis tree_diagnosis_from_state(const std::vector<Diagnosis>& tips, int unreachable_tip,
                                        const std::string& message) {
  is_index<kMaxTips>(unreachable_tip, "pickled TreeDiagnosis, unreachable_tip");
  TreeDiagnosis out;
  out.tips = tips;
  out.unreachable_tip = unreachable_tip;
  out.message = message;
  return out;
}

}  // namespace

void bind_tree_diagnosis(py::module_& m) {
  using D = TreeDiagnosis;
  auto cls =
      bind_class<D>(m, "TreeDiagnosis", "What TreeSolver.diagnose found.", "TreeSolver.diagnose");
  add_property(cls, "tips", &D::tips,
               "The Diagnosis of each tip's chain by itself, the others left out.");
  add_property(
      cls, "unreachable_tip", [](const D& self) { return tip_or_none(self.unreachable_tip); },
      "Index of the first tip that cannot be reached by itself; None if each can.");
  add_property(cls, "message", &D::message, "What is wrong, in a sentence.");
  def(cls, "__repr__", "", [](const D& self) {
    return "TreeDiagnosis(" + py::cast<std::string>(py::repr(py::str(self.message))) + ")";
  });
  def_pickle(cls, fn<&tree_diagnosis_state>, "tips, unreachable_tip, message",
             fn<&tree_diagnosis_from_state>);
}

}  // namespace iksel::python
