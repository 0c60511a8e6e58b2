// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <string>

#include "bindings.hpp"
#include "html.hpp"
#include "iksel/coupled_limit.hpp"
#include "joint_values.hpp"
#include "pickle.hpp"
#include "property.hpp"

namespace iksel::python {

namespace {

CoupledLimit make_limit(const JointValues& coefficients, const Loose<double>& lower,
                        const Loose<double>& upper) {
  CoupledLimit limit;
  limit.coefficients = as_joint_values(coefficients, "coefficients");
  limit.lower = from_python<double>(lower, "lower");
  limit.upper = from_python<double>(upper, "upper");
  return limit;
}

std::string limit_repr(const CoupledLimit& self) {
  const auto text = [](const auto& value) {
    return py::cast<std::string>(py::repr(py::cast(value)));
  };
  std::string all = "CoupledLimit(" + text(self.coefficients);
  const CoupledLimit defaults;
  if (self.lower != defaults.lower) all += ", lower=" + text(self.lower);
  if (self.upper != defaults.upper) all += ", upper=" + text(self.upper);
  return all + ")";
}

std::string limit_text(const CoupledLimit& self) {
  const CoupledLimit defaults;
  std::string text = to_string(self);
  if (self.lower != defaults.lower) text = short_number(self.lower) + " <= " + text;
  if (self.upper != defaults.upper) text += " <= " + short_number(self.upper);
  return text;
}

CoupledLimit limit_from_state(const py::object& state) {
  PickleState in(state, "CoupledLimit", 3);
  CoupledLimit limit;
  limit.coefficients =
      as_joint_values(JointValues(in.object()), "pickled CoupledLimit, coefficients");
  limit.lower = in.value<double>("lower");
  limit.upper = in.value<double>("upper");
  return limit;
}

}  // namespace

void bind_coupled_limit(py::module_& m) {
  const CoupledLimit defaults;
  py::class_<CoupledLimit> cls(
      m, "CoupledLimit",
      "A limit that joints share, as a parallel linkage or a cable makes it: "
      "lower <= sum of coefficient * joint value <= upper.");
  cls.def(py::init(&make_limit), py::arg("coefficients"), py::arg("lower") = defaults.lower,
          py::arg("upper") = defaults.upper,
          R"(Args:
    coefficients: by joint name; not 0. Joints between base and tip, mimic and locked ones too,
        but none that turns without limits.
    lower: least value of the sum [rad or m].
    upper: largest value of the sum [rad or m].

Raises:
    InvalidArgumentError: not names and numbers. What is wrong with the limit of a robot, it says
        when that is loaded.)");
  add_property(
      cls, "coefficients", [](const CoupledLimit& self) { return self.coefficients; },
      "Coefficients by joint name.");
  add_property(
      cls, "lower", [](const CoupledLimit& self) { return self.lower; },
      "Least value of the sum [rad or m].");
  add_property(
      cls, "upper", [](const CoupledLimit& self) { return self.upper; },
      "Largest value of the sum [rad or m].");
  cls.def("__repr__", &limit_repr);
  cls.def("__str__", &limit_text);
  cls.def(
      "__eq__",
      [](const CoupledLimit& self, const py::object& other) {
        return py::isinstance<CoupledLimit>(other) && self == py::cast<CoupledLimit>(other);
      },
      py::arg("other"));
  cls.attr("__hash__") = py::none();
  cls.def(py::pickle(
      [](const CoupledLimit& self) {
        return py::object(py::make_tuple(self.coefficients, self.lower, self.upper));
      },
      &limit_from_state));
}

}  // namespace iksel::python
