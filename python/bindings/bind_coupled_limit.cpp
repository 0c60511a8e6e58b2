// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

namespace iksel::python {

template <>
struct FieldTable<CoupledLimit> : HeaderTable<CoupledLimit> {};

namespace {

std::string limit_text(const CoupledLimit& self) {
  const auto short_number = [](double x) {
    return py::cast<std::string>(py::str("{:.5g}").format(x));
  };
  const CoupledLimit defaults;
  std::string text = to_string(self);
  if (self.lower != defaults.lower) text = short_number(self.lower) + " <= " + text;
  if (self.upper != defaults.upper) text += " <= " + short_number(self.upper);
  return text;
}

}  // namespace

void bind_coupled_limit(py::module_& m) {
  auto cls = bind_fields<CoupledLimit>(m, nullptr);
  def_init(
      cls, "coefficients, lower=-inf, upper=inf",
      [](const JointValues& coefficients, double lower, double upper) {
        return CoupledLimit{coefficients, lower, upper};
      },
      R"(Args:
    coefficients: by joint name; not 0. Joints between base and tip, mimic and locked ones too,
        but none that turns without limits.
    lower: least value of the sum [rad or m].
    upper: largest value of the sum [rad or m].

Raises:
    InvalidArgumentError: not names and numbers. What is wrong with the limit of a robot, it says
        when that is loaded.)");
  def(cls, "__str__", "", fn<&limit_text>);
  def_equal(cls);
}

}  // namespace iksel::python
