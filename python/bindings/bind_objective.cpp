// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <optional>
#include <string>

#include "bindings.hpp"
#include "joint_values.hpp"
#include "objective.hpp"
#include "pickle.hpp"
#include "property.hpp"

namespace iksel::python {

/// Checked by make_custom_objective.
class CostCallable : public py::object {
  PYBIND11_OBJECT_DEFAULT(CostCallable, object, is_any_object)
};

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::CostCallable> {
  static constexpr auto name = handle_type_name<typing::Callable<object(array_t<double>)>>::name;
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)

namespace iksel::python {

namespace {

JointVector as_any_joints(const ArrayLike& value, const char* name) {
  const DoubleArray array = as_doubles(value, name);
  if (array.ndim() != 1 || array.shape(0) > kMaxDof) {
    throw_wrong_shape(name, "a (dof,) array", array);
  }
  return as_joints(array, static_cast<int>(array.shape(0)), name);
}

/// The callable in a std::function that came from Python; None if it is empty.
template <class Held, class Function>
py::object callable_of(const Function& function) {
  const auto* held = function.template target<Held>();
  return held == nullptr ? py::none() : *held->callable;
}

py::object objective_state(const Objective& self) {
  return py::make_tuple(enum_name(self.kind), to_array(self.posture), to_array(self.weights),
                        callable_of<PyCost>(self.cost), callable_of<PyGradient>(self.gradient));
}

Objective objective_from_state(const py::object& state) {
  PickleState in(state, "Objective", 5);
  const auto kind = in.value<Objective::Kind>("kind");
  const JointVector posture = in.joints("posture");
  const JointVector weights = in.joints("weights");
  const py::object cost = in.object();
  const py::object gradient = in.object();
  switch (kind) {
    case Objective::Kind::none:
      return {};
    case Objective::Kind::posture:
      return Objective::near_posture(posture, weights);
    case Objective::Kind::limits:
      return Objective::far_from_limits();
    case Objective::Kind::manipulability:
      return Objective::most_manipulable();
    case Objective::Kind::custom:
      break;
  }
  return make_custom_objective(cost, gradient);
}

}  // namespace

void bind_objective(py::module_& m) {
  bind_enum<Objective::Kind>(m);
  py::class_<Objective> cls(
      m, "Objective",
      "What an answer is to be good at besides reaching the target: a cost of joint values, the "
      "smaller the better. Of all answers found the cheapest is taken; where the arm is free to "
      "move (more joints than fixed axes) the best are first moved along their self-motion to "
      "a local minimum of the cost. Immutable.");
  cls.def_static(
      "near_posture",
      [](const ArrayLike& posture, const std::optional<ArrayLike>& weights) {
        return Objective::near_posture(
            as_any_joints(posture, "posture"),
            weights ? as_any_joints(*weights, "weights") : JointVector());
      },
      py::arg("posture"), py::arg("weights") = py::none(),
      "Near joint values (dof,) [rad or m], inside the limits or not: 1/2 sum (w_i (q_i - "
      "posture_i))^2, weights (dof,), >= 0; None: all 1.");
  cls.def_static(
      "preferred",
      [](const Robot& robot, const JointValues& values, const std::optional<JointValues>& weights) {
        return Objective::preferred(
            robot, as_joint_values(values, "values"),
            weights ? as_joint_values(*weights, "weights") : std::map<std::string, double>());
      },
      py::arg("robot"), py::arg("values"), py::arg("weights") = py::none(),
      "Some joints, as a rail or a turntable, at a value where that is possible, else as near to "
      "it "
      "as may be: near_posture with weights of these joints only. Values by joint name [rad or m], "
      "and weights, > 0, of those that are to have another than 1. Between answers that are "
      "equally "
      "good `near` decides, or else the middle of the limits.");
  cls.def_static("far_from_limits", &Objective::far_from_limits,
                 "Far from the limits: sum 1/4 (1/x_i + 1/(1 - x_i)), x_i in 0 .. 1 the place "
                 "between them (Zghal, Dubey and Euler 1990).");
  cls.def_static("most_manipulable", &Objective::most_manipulable,
                 "Far from singularities: -sqrt(det(J J^T)) (Yoshikawa 1985); of J^T J with fewer "
                 "than 6 joints.");
  cls.def_static(
      "custom",
      [](const CostCallable& cost, const std::optional<CostCallable>& gradient) {
        return make_custom_objective(cost, gradient ? py::object(*gradient) : py::none());
      },
      py::arg("cost"), py::arg("gradient") = py::none(),
      "The cost of joint values (dof,) inside the limits, a number, and its gradient (dof,); "
      "without one, central differences of the cost. A cost of +inf refuses the joint values; NaN, "
      "-inf, or a gradient that is not finite is an InvalidArgumentError.");
  add_property(
      cls, "kind", [](const Objective& self) { return self.kind; }, "What it counts.");
  cls.def(py::pickle(&objective_state, &objective_from_state));
  cls.def("__repr__", [](const Objective& self) {
    return std::string("Objective(") + enum_name(self.kind) + ")";
  });
}

}  // namespace iksel::python
