// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <string>

#include "bindings.hpp"
#include "iksel/tree_solver.hpp"
#include "pickle.hpp"
#include "property.hpp"
#include "py_tree.hpp"

namespace iksel::python {

namespace {

py::object tree_diagnosis_state(const TreeDiagnosis& self) {
  return py::make_tuple(self.tips, self.unreachable_tip, self.message);
}

TreeDiagnosis tree_diagnosis_from_state(const py::object& state) {
  PickleState in(state, "TreeDiagnosis", 3);
  TreeDiagnosis out;
  for (const py::handle tip : in.list("tips")) {
    if (!py::isinstance<Diagnosis>(tip)) {
      in.refuse("tips", "Diagnoses", py::cast<std::string>(py::repr(tip)));
    }
    out.tips.push_back(py::cast<Diagnosis>(tip));
  }
  out.unreachable_tip = in.index<int>("unreachable_tip", static_cast<int>(out.tips.size()));
  out.message = in.value<std::string>("message");
  return out;
}

}  // namespace

void bind_tree_diagnosis(py::module_& m) {
  using D = TreeDiagnosis;
  py::class_<D> cls(m, "TreeDiagnosis", "What TreeSolver.diagnose found.");
  add_property(cls, "tips", &D::tips,
               "The Diagnosis of each tip's chain by itself, the others left out.");
  add_property(
      cls, "unreachable_tip", [](const D& self) { return tip_or_none(self.unreachable_tip); },
      "Index of the first tip that cannot be reached by itself; None if each can.");
  add_property(cls, "message", &D::message, "What is wrong, in a sentence.");
  cls.def("__repr__", [](const D& self) {
    return "TreeDiagnosis(" + py::cast<std::string>(py::repr(py::str(self.message))) + ")";
  });
  cls.def(py::pickle(&tree_diagnosis_state, &tree_diagnosis_from_state));
}

}  // namespace iksel::python
