// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/mimic_curve.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "array_fields.hpp"
#include "bindings.hpp"
#include "html.hpp"

namespace iksel::python {

/// A function of one number.
struct NumberFunction : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText =
      "collections.abc.Callable[[float], typing.SupportsFloat | typing.SupportsIndex]";
};

namespace {

using Numbers = std::vector<double>;

MimicCurve make_curve(const std::string& joint, const std::string& follows, const Numbers& q,
                      const Numbers& values, const std::optional<Numbers>& slopes) {
  MimicCurve curve;
  curve.joint = joint;
  curve.follows = follows;
  curve.q = q;
  curve.values = values;
  if (!slopes) return curve;
  curve.slopes = *slopes;
  if (curve.slopes.empty()) throw InvalidArgumentError("slopes: none are given; leave them out");
  return curve;
}

MimicCurve sample_curve(const std::string& joint, const std::string& follows, double lower,
                        double upper, const NumberFunction& function, const NumberFunction& slope) {
  check_callable(function, "function");
  check_callable(slope, "slope");
  return MimicCurve::sampled(joint, follows, lower, upper,
                             [&](double q) -> std::pair<double, double> {
                               return {from_python<double>(call_python(function, q), "function"),
                                       from_python<double>(call_python(slope, q), "slope")};
                             });
}

std::string curve_repr(const MimicCurve& self) {
  std::string text = "MimicCurve(" + repr_text(py::str(self.joint)) + ", " +
                     repr_text(py::str(self.follows)) + ", " + std::to_string(self.q.size()) +
                     " points";
  if (!self.q.empty()) {
    text += ", q=" + short_number(self.q.front()) + ".." + short_number(self.q.back());
  }
  return text + ")";
}

OptionalArray slopes_of(const MimicCurve& self) {
  return OptionalArray(self.slopes.empty() ? py::object(py::none()) : to_array(self.slopes));
}

py::dict curve_state(const MimicCurve& self) {
  return py::dict("joint"_a = self.joint, "follows"_a = self.follows, "q"_a = to_array(self.q),
                  "values"_a = to_array(self.values), "slopes"_a = slopes_of(self));
}

}  // namespace

void bind_mimic_curve(py::module_& m) {
  auto cls = bind_class<MimicCurve>(
      m, "MimicCurve",
      "A joint that follows another by a smooth curve, as a four-bar linkage or a cylinder beside "
      "a hinge makes it. It takes the place of the joint's mimic tag, which knows straight lines "
      "only. Between the points lies a cubic in each gap (Hermite's); the joint that is followed "
      "stays between the first point and the last.");
  def_init(cls, "joint, follows, q, values, slopes=None", fn<&make_curve>,
           R"(Args:
    joint: name of the joint that follows.
    follows: name of the joint that is followed; it follows none itself.
    q: values of the joint that is followed [rad or m], (N,), each above the one before.
    values: value of `joint` at each [rad or m], (N,).
    slopes: derivative of `values` by q at each, (N,); None: those of the cubic spline through the
        points, whose second derivative has no steps.

Raises:
    InvalidArgumentError: not names and arrays. What is wrong with the points, it says when a robot
        is loaded.)");
  def_static(cls, "sampled", "joint, follows, lower, upper, function, slope", fn<&sample_curve>,
             R"(The curve of a function, with so many points that it lies within 1e-10 of it.

Args:
    joint: name of the joint that follows.
    follows: name of the joint that is followed; it follows none itself.
    lower: where the curve begins [rad or m].
    upper: where it ends [rad or m].
    function: value of `joint` at a value of the joint that is followed [rad or m].
    slope: the function's derivative.

Raises:
    InvalidArgumentError: 8,192 gaps are not enough, as where slope is not function's derivative;
        or a function gives no finite number.)");
  add_property(cls, "joint", &MimicCurve::joint, "Name of the joint that follows.");
  add_property(cls, "follows", &MimicCurve::follows, "Name of the joint that is followed.");
  add_property(
      cls, "q", [](const MimicCurve& self) { return to_array(self.q); },
      "Values of the joint that is followed [rad or m], (N,).");
  add_property(
      cls, "values", [](const MimicCurve& self) { return to_array(self.values); },
      "Value of `joint` at each [rad or m], (N,).");
  add_property(cls, "slopes", &slopes_of,
               "Derivative of `values` by q at each, (N,); None: those of a cubic spline.");
  def(cls, "__repr__", "", fn<&curve_repr>);
  def_equal(cls);
  def_pickle(cls, fn<&curve_state>, "joint, follows, q, values, slopes", fn<&make_curve>);
}

}  // namespace iksel::python
