// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include "bindings.hpp"
#include "fields.hpp"
#include "html.hpp"
#include "iksel/coupled_limit.hpp"
#include "joint_values.hpp"

namespace iksel::python {

template <>
struct FieldTable<CoupledLimit> {
  static constexpr const char* kName = "CoupledLimit";
  static constexpr const char* kDoc =
      "A limit that joints share, as a parallel linkage or a cable makes it: "
      "lower <= sum of coefficient * joint value <= upper.";
  static std::vector<Field> fields() {
    return {field("coefficients", &CoupledLimit::coefficients, "Coefficients by joint name."),
            field("lower", &CoupledLimit::lower, "Least value of the sum [rad or m]."),
            field("upper", &CoupledLimit::upper, "Largest value of the sum [rad or m].")};
  }
};

namespace {

std::string limit_repr(const CoupledLimit& self) {
  const auto text = [](const auto& value) { return repr_text(py::cast(value)); };
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
  def(cls, "__repr__", "", fn<&limit_repr>);
  def(cls, "__str__", "", fn<&limit_text>);
  def_equal(cls);
}

}  // namespace iksel::python
