// SPDX-License-Identifier: BSD-3-Clause
// What robots are made with, as Python has it.
#pragma once

#include <utility>

#include "array_checks.hpp"

namespace iksel::python {

/// A sequence of link names.
class LinkNames : public py::object {
  PYBIND11_OBJECT_DEFAULT(LinkNames, object, is_any_object)
};

inline std::pair<double, double> as_limits(const ArrayLike& value, const char* name) {
  const DoubleArray array = as_doubles(value, name);
  if (array.ndim() != 1 || array.shape(0) != 2) {
    throw_wrong_shape(name, "two numbers, (lower, upper)", array);
  }
  return {array.at(0), array.at(1)};
}

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::LinkNames> {
  static constexpr auto name = const_name("collections.abc.Sequence[str]");
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)
