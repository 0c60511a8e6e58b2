// SPDX-License-Identifier: BSD-3-Clause
// What robots are made with, as Python has it.
#pragma once

#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>

#include "array_checks.hpp"
#include "joint_values.hpp"
#include "pickle.hpp"
#include "property.hpp"
#include "sequence_of.hpp"

namespace iksel::python {

/// A sequence of link names.
class LinkNames : public py::object {
  PYBIND11_OBJECT_DEFAULT(LinkNames, object, is_any_object)
};

/// A sequence of CoupledLimit.
class CoupledLimits : public py::object {
  PYBIND11_OBJECT_DEFAULT(CoupledLimits, object, is_any_object)
};

inline std::pair<double, double> as_limits(const ArrayLike& value, const char* name) {
  const DoubleArray array = as_doubles(value, name);
  if (array.ndim() != 1 || array.shape(0) != 2) {
    throw_wrong_shape(name, "two numbers, (lower, upper)", array);
  }
  return {array.at(0), array.at(1)};
}

/// The options that a robot of one tip and one of several have in common.
template <class Options>
void set_common_options(const std::optional<Loose<std::string>>& base_link,
                        const std::optional<JointValues>& locked_joints,
                        const Loose<bool>& soft_limits,
                        const std::optional<ArrayLike>& default_limits,
                        const CoupledLimits& coupled_limits, Options& options) {
  if (base_link) options.base_link = from_python<std::string>(*base_link, "base_link");
  if (locked_joints) options.locked_joints = as_joint_values(*locked_joints, "locked_joints");
  options.soft_limits = from_python<bool>(soft_limits, "soft_limits");
  if (default_limits) options.default_limits = as_limits(*default_limits, "default_limits");
  options.coupled_limits =
      as_sequence_of<CoupledLimit>(coupled_limits, "coupled_limits", "CoupledLimit");
}

template <class Options>
py::tuple common_state(const Options& options) {
  return py::make_tuple(options.base_link, options.locked_joints, options.soft_limits,
                        options.default_limits, options.coupled_limits);
}

/// The items of common_state().
template <class Options>
void set_common_options(PickleState& in, Options& options) {
  options.base_link = in.value<std::string>("base_link");
  options.locked_joints =
      as_joint_values(JointValues(in.object()), in.name("locked_joints").c_str());
  options.soft_limits = in.value<bool>("soft_limits");
  const py::object limits = in.object();
  if (!limits.is_none()) {
    options.default_limits = as_limits(ArrayLike(limits), in.name("default_limits").c_str());
  }
  options.coupled_limits =
      as_sequence_of<CoupledLimit>(in.object(), in.name("coupled_limits"), "CoupledLimit");
}

template <class AnyRobot>
void bind_common_options(py::class_<AnyRobot>& cls) {
  add_property(
      cls, "locked_joints", [](const AnyRobot& self) { return self.options().locked_joints; },
      "Joints held at a value [rad or m], by name.");
  add_property(
      cls, "soft_limits", [](const AnyRobot& self) { return self.options().soft_limits; },
      "Whether the limits are narrowed to the safety controller's.");
  add_property(
      cls, "default_limits", [](const AnyRobot& self) { return self.options().default_limits; },
      "Lower and upper limit of joints that the URDF gives none [rad or m], or None.");
  add_property(
      cls, "coupled_limits", [](const AnyRobot& self) { return self.options().coupled_limits; },
      "Limits of sums of joint values, beside those of each joint.");
}

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::CoupledLimits> {
  static constexpr auto name = const_name("collections.abc.Sequence[iksel_cpp.CoupledLimit]");
};
template <>
struct handle_type_name<iksel::python::LinkNames> {
  static constexpr auto name = const_name("collections.abc.Sequence[str]");
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)
