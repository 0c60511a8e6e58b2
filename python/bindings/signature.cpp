// SPDX-License-Identifier: BSD-3-Clause
#include "signature.hpp"

#include <pybind11/stl.h>

#include <cstddef>
#include <utility>

#include "fit.hpp"

namespace iksel::python {

namespace {

/// How to come by an object whose class has no constructor.
constexpr std::pair<const char*, const char*> kMakers[] = {
    {"Robot", "iksel.load_robot(name) or Robot.from_urdf(path_or_xml)"},
    {"LinkTree", "LinkTree.from_urdf(path_or_xml)"},
    {"LinkTreeJoint", "LinkTree.from_urdf(path_or_xml).joints"},
    {"Structure", "Robot.structure"},
    {"Database", "Database.build(robot) or Database.load(path)"},
    {"Objective",
     "Objective.near_posture(posture), far_from_limits(), most_manipulable() or custom(cost)"},
    {"Result", "Solver.solve"},
    {"BatchResult", "Solver.solve_batch"},
    {"Solutions", "Solver.solve_all"},
    {"PathResult", "Solver.solve_path"},
    {"SelfMotion", "Solver.self_motion"},
    {"SelfMotionArc", "Solver.self_motion"},
    {"SelfMotionEnd", "Solver.self_motion"},
    {"Contact", "Scene.contacts"},
    {"Diagnosis", "Solver.diagnose"},
    {"Obstacle", "Scene.obstacles"},
    {"Evaluation", "evaluate"},
    {"TreeRobot", "TreeRobot.from_urdf"},
    {"TreeResult", "TreeSolver.solve"},
    {"TreeBatchResult", "TreeSolver.solve_batch"},
    {"TreeDiagnosis", "TreeSolver.diagnose"},
};

int refuse_constructor(PyObject* self, PyObject* /*args*/, PyObject* /*kwargs*/) {
  std::string name = Py_TYPE(self)->tp_name;
  std::string makers = "other functions";
  for (const PyTypeObject* type = Py_TYPE(self); type != nullptr; type = type->tp_base) {
    const std::string full = type->tp_name;
    for (const auto& [maker, how] : kMakers) {
      if (full.substr(full.rfind('.') + 1) != maker) continue;
      name = maker;
      makers = how;
    }
  }
  const std::string text = name + " is not made by calling it, but by " + makers;
  PyErr_SetString(py::module_::import("iksel_cpp").attr("SignatureError").ptr(), text.c_str());
  return -1;
}

/// pybind11 would hand out memory that nobody has written to.
void* refuse_unmade(std::size_t /*size*/) {
  throw InvalidArgumentError(
      "this object was never made: its class was called by __new__ alone, or a pickle ended "
      "before the object's state");
}

void guard_class(PyTypeObject* type) {
  py::detail::get_type_info(type)->operator_new = &refuse_unmade;
  const auto* base = reinterpret_cast<PyTypeObject*>(py::detail::get_internals().instance_base);
  const bool has_constructor = type->tp_init != base->tp_init;
  if (!has_constructor) type->tp_init = &refuse_constructor;
}

/// A METH_FASTCALL | METH_KEYWORDS function.
using FastCall = PyObject* (*)(PyObject*, PyObject* const*, Py_ssize_t, PyObject*);

/// pybind11's function that all calls go through.
FastCall dispatch = nullptr;

/// As pybind11 calls, but with a sentence if no overload fits.
PyObject* call(PyObject* self, PyObject* const* args, Py_ssize_t count, PyObject* keywords) {
  PyObject* result = dispatch(self, args, count, keywords);
  // pybind11's own errors of this kind are exactly a TypeError.
  if (result == nullptr && PyErr_Occurred() == PyExc_TypeError) {
    explain_misfit(self, args, count, keywords);
  }
  return result;
}

void guard_function(py::handle thing) {
  const py::handle function = py::detail::get_function(thing);
  if (!function || PyCFunction_Check(function.ptr()) == 0) return;
  PyObject* self = PyCFunction_GET_SELF(function.ptr());
  if (self == nullptr || py::detail::function_record_ptr_from_PyObject(self) == nullptr) return;
  PyMethodDef* definition = reinterpret_cast<PyCFunctionObject*>(function.ptr())->m_ml;
  // Of an older pybind11, whose calls look otherwise: they keep its words.
  if (definition->ml_flags != (METH_FASTCALL | METH_KEYWORDS)) return;
  const auto current =
      reinterpret_cast<FastCall>(reinterpret_cast<void (*)()>(definition->ml_meth));
  if (current == &call) return;
  dispatch = current;
  definition->ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&call));
}

}  // namespace

std::string did_you_mean(const std::string& name, const std::vector<std::string>& known) {
  std::vector<std::string> close;
  // Of tip_link the word tip; two letters are too few to tell.
  for (const std::string& one : name.size() > 2 ? known : std::vector<std::string>()) {
    if (("_" + one).find("_" + name) != std::string::npos) close.push_back(one);
  }
  if (close.empty()) {
    close = py::cast<std::vector<std::string>>(
        py::module_::import("difflib").attr("get_close_matches")(name, py::cast(known), 1));
  }
  std::string text;
  for (const std::string& one : close) text += (text.empty() ? "'" : " or '") + one + "'";
  return text.empty() ? "" : "; did you mean " + text + "?";
}

void guard_module(py::module_& m) {
  const auto* metaclass = py::detail::get_internals().default_metaclass;
  for (const auto& [name, thing] : py::dict(m.attr("__dict__"))) {
    guard_function(thing);
    if (Py_TYPE(thing.ptr()) != metaclass) continue;
    auto* type = reinterpret_cast<PyTypeObject*>(thing.ptr());
    guard_class(type);
    for (const auto& member : py::dict(thing.attr("__dict__"))) {
      guard_function(thing.attr(member.first));
    }
  }
}

}  // namespace iksel::python
