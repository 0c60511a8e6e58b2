// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/mimic_curve.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "html.hpp"
#include "pickle.hpp"
#include "property.hpp"

namespace iksel::python {

/// A function of one number.
class NumberFunction : public py::object {
  PYBIND11_OBJECT_DEFAULT(NumberFunction, object, is_any_object)
};

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::NumberFunction> {
  static constexpr auto name = handle_type_name<typing::Callable<double(double)>>::name;
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)

namespace iksel::python {

namespace {

std::vector<double> as_numbers(const py::handle& value, const char* name) {
  const DoubleArray array = as_doubles(value, name);
  if (array.ndim() != 1) throw_wrong_shape(name, "an (N,) array", array);
  return {array.data(), array.data() + array.size()};
}

py::array_t<double> as_array(const std::vector<double>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

MimicCurve make_curve(const Loose<std::string>& joint, const Loose<std::string>& follows,
                      const ArrayLike& q, const ArrayLike& values,
                      const std::optional<ArrayLike>& slopes) {
  MimicCurve curve;
  curve.joint = from_python<std::string>(joint, "joint");
  curve.follows = from_python<std::string>(follows, "follows");
  curve.q = as_numbers(q, "q");
  curve.values = as_numbers(values, "values");
  if (!slopes) return curve;
  curve.slopes = as_numbers(*slopes, "slopes");
  if (curve.slopes.empty()) throw InvalidArgumentError("slopes: none are given; leave them out");
  return curve;
}

MimicCurve sample_curve(const Loose<std::string>& joint, const Loose<std::string>& follows,
                        const Loose<double>& lower, const Loose<double>& upper,
                        const NumberFunction& function, const NumberFunction& slope) {
  check_callable(function, "function");
  check_callable(slope, "slope");
  return MimicCurve::sampled(
      from_python<std::string>(joint, "joint"), from_python<std::string>(follows, "follows"),
      from_python<double>(lower, "lower"), from_python<double>(upper, "upper"),
      [&](double q) -> std::pair<double, double> {
        return {from_python<double>(call_python(function, q), "function"),
                from_python<double>(call_python(slope, q), "slope")};
      });
}

std::string curve_repr(const MimicCurve& self) {
  std::string text = "MimicCurve(" + py::cast<std::string>(py::repr(py::str(self.joint))) + ", " +
                     py::cast<std::string>(py::repr(py::str(self.follows))) + ", " +
                     std::to_string(self.q.size()) + " points";
  if (!self.q.empty()) {
    text += ", q=" + short_number(self.q.front()) + ".." + short_number(self.q.back());
  }
  return text + ")";
}

MimicCurve curve_from_state(const py::object& state) {
  PickleState in(state, "MimicCurve", 5);
  MimicCurve curve;
  curve.joint = in.value<std::string>("joint");
  curve.follows = in.value<std::string>("follows");
  curve.q = as_numbers(in.object(), "pickled MimicCurve, q");
  curve.values = as_numbers(in.object(), "pickled MimicCurve, values");
  const py::object slopes = in.object();
  if (!slopes.is_none()) curve.slopes = as_numbers(slopes, "pickled MimicCurve, slopes");
  return curve;
}

py::object slopes_of(const MimicCurve& self) {
  if (self.slopes.empty()) return py::none();
  return as_array(self.slopes);
}

}  // namespace

void bind_mimic_curve(py::module_& m) {
  py::class_<MimicCurve> cls(
      m, "MimicCurve",
      "A joint that follows another by a smooth curve, as a four-bar linkage or a cylinder beside "
      "a hinge makes it. It takes the place of the joint's mimic tag, which knows straight lines "
      "only. Between the points lies a cubic in each gap (Hermite's); the joint that is followed "
      "stays between the first point and the last.");
  cls.def(py::init(&make_curve), py::arg("joint"), py::arg("follows"), py::arg("q"),
          py::arg("values"), py::arg("slopes") = py::none(),
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
  cls.def_static("sampled", &sample_curve, py::arg("joint"), py::arg("follows"), py::arg("lower"),
                 py::arg("upper"), py::arg("function"), py::arg("slope"),
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
      cls, "q", [](const MimicCurve& self) { return as_array(self.q); },
      "Values of the joint that is followed [rad or m], (N,).");
  add_property(
      cls, "values", [](const MimicCurve& self) { return as_array(self.values); },
      "Value of `joint` at each [rad or m], (N,).");
  add_property(cls, "slopes", &slopes_of,
               "Derivative of `values` by q at each, (N,); None: those of a cubic spline.");
  cls.def("__repr__", &curve_repr);
  cls.def(
      "__eq__",
      [](const MimicCurve& self, const py::object& other) {
        return py::isinstance<MimicCurve>(other) && self == py::cast<MimicCurve>(other);
      },
      py::arg("other"));
  cls.attr("__hash__") = py::none();
  cls.def(py::pickle(
      [](const MimicCurve& self) {
        return py::object(py::make_tuple(self.joint, self.follows, as_array(self.q),
                                         as_array(self.values), slopes_of(self)));
      },
      &curve_from_state));
}

}  // namespace iksel::python
