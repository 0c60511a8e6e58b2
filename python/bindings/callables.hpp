// SPDX-License-Identifier: BSD-3-Clause
// Functions from Python: costs, and what refuses candidates.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "array_checks.hpp"

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

/// The cost and the gradient, where they came from Python.
inline std::array<std::shared_ptr<py::object>, 2> callables_of(const Objective& objective) {
  const auto* cost = objective.cost.target<PyCost>();
  const auto* gradient = objective.gradient.target<PyGradient>();
  return {cost == nullptr ? nullptr : cost->callable,
          gradient == nullptr ? nullptr : gradient->callable};
}

inline const Objective& objective_of(const Objective& self) { return self; }
inline const Objective& objective_of(const Tracker& self) { return self.objective(); }

/// Shows the garbage collector the callables of an object, which often hold the object themselves:
/// a method of what has the tracker, a function of a module that does.
template <class T>
struct CollectedCallables {
  static void set_up(PyTypeObject* type) {
    type->tp_flags |= Py_TPFLAGS_HAVE_GC;
    type->tp_traverse = [](PyObject* self, visitproc visit, void* arg) {
      Py_VISIT(Py_TYPE(self));
      for (const py::object* callable : own(self)) Py_VISIT(callable->ptr());
      return 0;
    };
    type->tp_clear = [](PyObject* self) {
      for (py::object* callable : own(self)) {
        const py::object gone = std::exchange(*callable, py::none());
      }
      return 0;
    };
  }

 private:
  /// Those that no copy shares, which would show them once more than they are held. Copies are made
  /// with the lock held, so never while garbage is collected.
  static std::vector<py::object*> own(PyObject* self) {
    std::vector<py::object*> found;
    if (is_unmade(self)) return found;
    for (const auto& callable : callables_of(objective_of(py::cast<const T&>(py::handle(self))))) {
      constexpr int kHereAndInSelf = 2;
      if (callable.use_count() == kHereAndInSelf) found.push_back(callable.get());
    }
    return found;
  }
};
template <>
struct Collected<Objective> : CollectedCallables<Objective> {};
template <>
struct Collected<Tracker> : CollectedCallables<Tracker> {};

/// An Objective, the name of one that needs nothing else, or a cost function.
template <>
struct FromPython<Objective> {
  static std::string text() {
    return "iksel_cpp.Objective | str | collections.abc.Callable[[numpy.ndarray], float]";
  }
  static Objective convert(py::handle value, const char* name) {
    if (is_a<Objective>(value)) {
      const auto& given = made<Objective>(value);
      const auto [cost, gradient] = callables_of(given);
      if (!cost) return given;
      // What comes of it does not share them: see Collected.
      return make_custom_objective(*cost, gradient ? *gradient : py::none());
    }
    if (py::isinstance<py::str>(value)) {
      const std::string given = as_text(value, name);
      if (given == enum_name(Objective::Kind::limits)) return Objective::far_from_limits();
      if (given == enum_name(Objective::Kind::manipulability)) return Objective::most_manipulable();
    } else if (PyCallable_Check(value.ptr()) != 0) {
      return make_custom_objective(value, py::none());
    }
    throw_wrong_type(name, "an Objective, a callable, or one of limits, manipulability", value);
  }
};

/// A filter that calls `callable` with an (n, dof) array and expects n truth values; an exception
/// passes through the solve to the caller. The callable and its name must outlive the filter.
template <>
struct FromPython<Filter> {
  static std::string text() {
    return "collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], object]";
  }
  static Filter convert(py::handle callable, const char* name, int dof) {
    check_callable(callable, name);
    return [callable, name, dof](const double* q, std::size_t count, bool* keep) {
      const GilAcquire acquire;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      const auto n = static_cast<py::ssize_t>(count);
      py::array_t<double> candidates({n, static_cast<py::ssize_t>(dof)});
      std::copy_n(q, count * static_cast<std::size_t>(dof), candidates.mutable_data());
      const py::object answer = call_python(callable, candidates);
      const auto array = py::array::ensure(answer);
      if (!array) throw_wrong_type(name, "an array of truth values", answer);
      const char kind = array.dtype().kind();
      if (kind != 'b' || array.size() != n || array.ndim() > 1) {
        throw InvalidArgumentError(std::string(name) + ": expected to get back " +
                                   std::to_string(n) + " truth values for the (" +
                                   std::to_string(n) + ", " + std::to_string(dof) +
                                   ") candidates, got shape " + shape_text(array) + " of dtype " +
                                   py::cast<std::string>(py::str(array.dtype())));
      }
      const auto flags = py::array_t<bool>::ensure(array);
      std::copy_n(flags.data(), count, keep);
    };
  }
};

}  // namespace iksel::python
