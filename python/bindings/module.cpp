// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

PYBIND11_MODULE(iksel_cpp_of_main, m) {
  m.doc() = R"(IKSel: inverse kinematics from precomputed seeds.

A pose is that of the TCP, or of the tip link if there is no tool, in the base frame: a (4, 4)
homogeneous matrix; lengths are metres, angles radians. A twist is [linear; angular] in base axes at
the TCP. The method is that of "IKSel: Selecting Good Seed Joint Values for Fast Numerical Inverse
Kinematics Iterations" (Yuan, Wan, Harada, 2025), called the paper below.)";
  m.attr("__version__") = iksel::kVersion;
  iksel::python::def(
      m, "_describe", "value",
      [](const pybind11::object& value) { return iksel::python::describe(value); },
      "A value as messages show it.");
  iksel::python::bind_errors(m);
  iksel::python::bind_link_tree(m);
  iksel::python::bind_mimic_curve(m);
  iksel::python::bind_robot(m);
  iksel::python::bind_pose(m);
  iksel::python::bind_options(m);
  iksel::python::bind_database(m);
  iksel::python::bind_scene(m);
  iksel::python::bind_objective(m);
  iksel::python::bind_result(m);
  iksel::python::bind_diagnosis(m);
  iksel::python::bind_solver(m);
  iksel::python::bind_evaluation(m);
  iksel::python::bind_selector(m);
}

// What Python looks for. In another interpreter than the first of a process, pybind11 would wait
// for ever for the lock that this thread holds.
extern "C" PYBIND11_EXPORT PyObject* PyInit_iksel_cpp() {
  if (PyInterpreterState_Get() == PyInterpreterState_Main()) return PyInit_iksel_cpp_of_main();
  PyErr_SetString(PyExc_ImportError,
                  "iksel cannot be imported in a subinterpreter, only in a process's main "
                  "interpreter; under mod_wsgi set 'WSGIApplicationGroup %{GLOBAL}'");
  return nullptr;
}
