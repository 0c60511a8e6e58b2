// SPDX-License-Identifier: BSD-3-Clause
// Objectives from Python: an Objective, the name of one that needs nothing else, or a cost
// function.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "array_checks.hpp"
#include "gil.hpp"
#include "iksel/objective.hpp"
#include "python_types.hpp"

namespace iksel::python {

/// A callable that may be copied and dropped without the GIL.
inline std::shared_ptr<py::object> hold(py::handle callable) {
  return {new py::object(py::reinterpret_borrow<py::object>(callable)), [](py::object* held) {
            const GilAcquire acquire;
            delete held;
          }};
}

/// A cost function from Python; a type of its own, so that pickling finds the callable again.
struct PyCost {
  std::shared_ptr<py::object> callable;

  double operator()(const JointVector& q) const {
    const GilAcquire acquire;
    return from_python<double>(call_python(*callable, to_array(q)), "cost");
  }
};

struct PyGradient {
  std::shared_ptr<py::object> callable;

  JointVector operator()(const JointVector& q) const {
    const GilAcquire acquire;
    return as_joints(call_python(*callable, to_array(q)), static_cast<int>(q.size()), "gradient");
  }
};

inline Objective make_custom_objective(py::handle cost, py::handle gradient) {
  check_callable(cost, "cost");
  Objective objective = Objective::custom(PyCost{hold(cost)});
  if (!gradient.is_none()) {
    check_callable(gradient, "gradient");
    objective.gradient = PyGradient{hold(gradient)};
  }
  return objective;
}

inline Objective as_objective(py::handle value) {
  if (is_a<Objective>(value)) return made<Objective>(value);
  if (py::isinstance<py::str>(value)) {
    const std::string name = as_text(value, "objective");
    if (name == enum_name(Objective::Kind::limits)) return Objective::far_from_limits();
    if (name == enum_name(Objective::Kind::manipulability)) return Objective::most_manipulable();
  } else if (PyCallable_Check(value.ptr()) != 0) {
    return make_custom_objective(value, py::none());
  }
  throw_wrong_type("objective", "an Objective, a callable, or one of limits, manipulability",
                   value);
}

}  // namespace iksel::python
