// SPDX-License-Identifier: BSD-3-Clause
// The fields of the option structs, as iksel/options.hpp declares them.
#pragma once

#include <string>
#include <vector>

#include "fields.hpp"

namespace iksel::python {

template <>
struct FieldTable<Task> : HeaderTable<Task> {};
template <>
struct FieldTable<DatabaseOptions> : HeaderTable<DatabaseOptions> {};
template <>
struct FieldTable<Lanes> : HeaderTable<Lanes> {};
template <>
struct FieldTable<Paper> : HeaderTable<Paper> {};

/// A strategy by its class, by its name, or as a mapping of a name and fields.
template <>
struct FromPython<Strategy> {
  static std::string text() {
    return "iksel_cpp.Lanes | iksel_cpp.Paper | str | collections.abc.Mapping[str, object]";
  }
  static Strategy convert(py::handle value, const char* name);
};

template <>
struct ResultType<Strategy> {
  static std::string text() { return "iksel_cpp.Lanes | iksel_cpp.Paper"; }
};

template <>
struct ValueOf<Strategy> {
  /// A copy: what is held may be of the other class later.
  static py::object get(const Strategy& value, py::handle owner);
  static py::object to_plain(const Strategy& value);
};

template <>
struct FieldTable<SolverOptions> : HeaderTable<SolverOptions> {};

}  // namespace iksel::python
