// SPDX-License-Identifier: BSD-3-Clause
#include <optional>
#include <string>

#include "array_fields.hpp"
#include "bindings.hpp"
#include "joint_values.hpp"
#include "objective.hpp"
#include "property.hpp"

namespace iksel::python {

/// Checked by make_custom_objective.
struct CostCallable : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText =
      "collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], object]";
};

namespace {

/// The callable in a std::function that came from Python; None if it is empty.
template <class Held, class Function>
py::object callable_of(const Function& function) {
  const auto* held = function.template target<Held>();
  return held == nullptr ? py::none() : *held->callable;
}

py::dict objective_state(const Objective& self) {
  return py::dict("kind"_a = enum_name(self.kind), "posture"_a = to_array(self.posture),
                  "weights"_a = to_array(self.weights), "cost"_a = callable_of<PyCost>(self.cost),
                  "gradient"_a = callable_of<PyGradient>(self.gradient));
}

Objective objective_from_state(Objective::Kind kind, const JointVector& posture,
                               const JointVector& weights, const py::object& cost,
                               const py::object& gradient) {
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

Objective near_posture(const ArrayLike& posture, const std::optional<ArrayLike>& weights) {
  return Objective::near_posture(as_any_joints(posture, "posture"),
                                 weights ? as_any_joints(*weights, "weights") : JointVector());
}

Objective preferred(const Robot& robot, const JointValues& values,
                    const std::optional<JointValues>& weights) {
  return Objective::preferred(robot, values, weights.value_or(JointValues()));
}

Objective custom(const CostCallable& cost, const std::optional<CostCallable>& gradient) {
  return make_custom_objective(cost, gradient ? py::handle(*gradient) : py::none());
}

}  // namespace

void bind_objective(py::module_& m) {
  bind_enum<Objective::Kind>(m);
  auto cls = bind_class<Objective>(
      m, "Objective",
      "What an answer is to be good at besides reaching the target: a cost of joint values, the "
      "smaller the better. Of all answers found the cheapest is taken; where the arm is free to "
      "move (more joints than fixed axes) the best are first moved along their self-motion to "
      "a local minimum of the cost. Immutable.",
      "Objective.near_posture(posture), far_from_limits(), most_manipulable() or custom(cost)");
  def_static(cls, "near_posture", "posture, weights=None", fn<&near_posture>,
             "Near joint values (dof,) [rad or m], inside the limits or not: 1/2 sum (w_i (q_i - "
             "posture_i))^2, weights (dof,), >= 0; None: all 1.");
  def_static(
      cls, "preferred", "robot, values, weights=None", fn<&preferred>,
      "Some joints, as a rail or a turntable, at a value where that is possible, else as near to "
      "it "
      "as may be: near_posture with weights of these joints only. Values by joint name [rad or m], "
      "and weights, > 0, of those that are to have another than 1. Between answers that are "
      "equally "
      "good `near` decides, or else the middle of the limits.");
  def_static(cls, "far_from_limits", "", fn<&Objective::far_from_limits>,
             "Far from the limits: sum 1/4 (1/x_i + 1/(1 - x_i)), x_i in 0 .. 1 the place "
             "between them (Zghal, Dubey and Euler 1990).");
  def_static(cls, "most_manipulable", "", fn<&Objective::most_manipulable>,
             "Far from singularities: -sqrt(det(J J^T)) (Yoshikawa 1985); of J^T J with fewer "
             "than 6 joints.");
  def_static(
      cls, "custom", "cost, gradient=None", fn<&custom>,
      "The cost of joint values (dof,) inside the limits, a number, and its gradient (dof,); "
      "without one, central differences of the cost. A cost of +inf refuses the joint values; NaN, "
      "-inf, or a gradient that is not finite is an InvalidArgumentError.");
  add_property(
      cls, "kind", [](const Objective& self) { return self.kind; }, "What it counts.");
  def(cls, "__repr__", "",
      [](const Objective& self) { return std::string("Objective(") + enum_name(self.kind) + ")"; });
  def_pickle(cls, fn<&objective_state>, "kind, posture, weights, cost, gradient",
             fn<&objective_from_state>);
}

}  // namespace iksel::python
