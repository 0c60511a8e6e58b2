// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

namespace iksel::python {

/// A function of one number.
struct NumberFunction : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText =
      "collections.abc.Callable[[float], typing.SupportsFloat | typing.SupportsIndex]";
};

template <>
struct FieldTable<MimicCurve> : HeaderTable<MimicCurve> {
  static std::vector<Field> fields() { return HeaderFields<MimicCurve>().hide({"slopes"}).all(); }
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

OptionalArray slopes_of(const MimicCurve& self) {
  return OptionalArray(self.slopes.empty() ? py::object(py::none()) : to_array(self.slopes));
}

}  // namespace

void bind_mimic_curve(py::module_& m) {
  auto cls = bind_fields<MimicCurve>(m, nullptr);
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
  add_property(cls, "slopes", &slopes_of);
  def_equal(cls);
}

}  // namespace iksel::python
