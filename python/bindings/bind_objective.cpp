// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "callables.hpp"

namespace iksel::python {

/// Checked by make_custom_objective.
struct CostCallable : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText =
      "collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], object]";
};

namespace {

py::dict objective_state(const Objective& self) {
  const auto [cost, gradient] = callables_of(self);
  return py::dict("kind"_a = enum_name(self.kind), "posture"_a = to_array(self.posture),
                  "weights"_a = to_array(self.weights), "cost"_a = cost ? *cost : py::none(),
                  "gradient"_a = gradient ? *gradient : py::none());
}

Objective objective_from_state(Objective::Kind kind, const JointVector& posture,
                               const JointVector& weights, const py::object& cost,
                               const py::object& gradient) {
  if (kind == Objective::Kind::custom) return make_custom_objective(cost, gradient);
  Objective objective;
  objective.kind = kind;
  objective.posture = posture;
  objective.weights = weights;
  return objective;
}

Objective near_posture(const ArrayLike& posture, const JointVector& weights) {
  return Objective::near_posture(as_any_joints(posture, "posture"), weights);
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
  bind_enums<Objective::Kind>(m);
  auto cls = bind_class<Objective>(
      m, "Objective",
      "Objective.near_posture(posture), far_from_limits(), most_manipulable() or custom(cost)");
  def_static(cls, "near_posture", "posture, weights=None", fn<&near_posture>);
  def_static(cls, "preferred", "robot, values, weights=None", fn<&preferred>);
  def_static(cls, "far_from_limits", "", fn<&Objective::far_from_limits>);
  def_static(cls, "most_manipulable", "", fn<&Objective::most_manipulable>);
  def_static(
      cls, "custom", "cost, gradient=None", fn<&custom>,
      "The cost of joint values (dof,) inside the limits, a number, and its gradient (dof,); "
      "without one, central differences of the cost. A cost of +inf refuses the joint values; NaN, "
      "-inf, or a gradient that is not finite is an InvalidArgumentError.");
  add_property(cls, "kind", [](const Objective& self) { return self.kind; });
  def_repr(cls);
  def_pickle(cls, fn<&objective_state>, "kind, posture, weights, cost, gradient",
             fn<&objective_from_state>);
}

}  // namespace iksel::python
