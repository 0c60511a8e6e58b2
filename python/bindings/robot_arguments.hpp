// SPDX-License-Identifier: BSD-3-Clause
// What robots are made with, as Python has it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "array_checks.hpp"
#include "iksel/coupled_limit.hpp"
#include "iksel/mimic_curve.hpp"
#include "joint_values.hpp"
#include "property.hpp"
#include "sequence_of.hpp"

namespace iksel::python {

/// Lower and upper.
using Limits = std::pair<double, double>;

template <>
struct FromPython<Limits> {
  static std::string text() { return ArrayLike::kText; }
  static Limits convert(py::handle value, const char* name) {
    const DoubleArray array = as_doubles(value, name);
    if (array.ndim() != 1 || array.shape(0) != 2) {
      throw_wrong_shape(name, "two numbers, (lower, upper)", array);
    }
    return {array.at(0), array.at(1)};
  }
};

template <>
struct FromPython<std::vector<CoupledLimit>> : FromSequence<CoupledLimit> {};
template <>
struct FromPython<std::vector<MimicCurve>> : FromSequence<MimicCurve> {};

/// Properties that a robot of one tip and one of several have in common.
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
