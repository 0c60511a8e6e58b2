// SPDX-License-Identifier: BSD-3-Clause
// Read-only properties. pybind11's own way makes a compiler spend a tenth of a second on each; here
// all getters of the same type share their code.
#pragma once

#include <pybind11/pybind11.h>

#include <type_traits>

namespace iksel::python {

namespace py = pybind11;

namespace detail {

/// A lambda without captures as the function that it is.
template <class Get>
auto as_function(Get get, int /*preferred*/) -> decltype(+get) {
  return +get;
}
template <class Get>
Get as_function(Get get, long /*otherwise*/) {
  return get;
}

inline void set_property(const py::object& cls, const char* name, const py::cpp_function& getter,
                         const char* doc) {
  const py::handle property(reinterpret_cast<PyObject*>(&PyProperty_Type));
  cls.attr(name) = property(getter, py::none(), py::none(), doc);
}

}  // namespace detail

/// `get`: a function of the object, a method or a member.
template <class Class, class... Options, class Get>
void add_property(py::class_<Class, Options...>& cls, const char* name, Get get, const char* doc) {
  constexpr auto kPolicy = py::return_value_policy::reference_internal;
  py::cpp_function getter;
  if constexpr (std::is_member_object_pointer_v<Get>) {
    getter = py::cpp_function(
        [get](const Class& self) -> const auto& { return self.*get; }, py::is_method(cls), kPolicy);
  } else {
    getter = py::cpp_function(detail::as_function(get, 0), py::is_method(cls), kPolicy);
  }
  detail::set_property(cls, name, getter, doc);
}

}  // namespace iksel::python
