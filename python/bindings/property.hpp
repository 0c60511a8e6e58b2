// SPDX-License-Identifier: BSD-3-Clause
// Read-only properties, whose getters share the code around them.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <type_traits>

#include "class.hpp"
#include "results.hpp"

namespace iksel::python {

using Getter = std::function<py::object(py::handle)>;
using Setter = std::function<void(py::handle, py::handle)>;

/// With the types that stubs show; without `set` nobody may set it.
void set_property(const py::object& cls, const char* name, const std::string& type, Getter get,
                  const char* doc, const std::string& given_type = "", Setter set = nullptr);

/// `get`: a function of the object, a method or a member.
template <class Class, class Get>
void add_property(py::class_<Class>& cls, const char* name, Get get, const char* doc) {
  using Result = std::invoke_result_t<Get, Class&>;
  set_property(
      cls, name, type_text<Result>(),
      [get](py::handle self) {
        return to_python<Result>(std::invoke(get, made<Class>(self)), self);
      },
      doc);
}

}  // namespace iksel::python
