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

/// Names of links; a text alone is no list of them.
struct LinkNames : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "collections.abc.Sequence[str]";
};

template <>
struct FromPython<std::vector<CoupledLimit>> : FromSequence<CoupledLimit> {};
template <>
struct FromPython<std::vector<MimicCurve>> : FromSequence<MimicCurve> {};

}  // namespace iksel::python
