// SPDX-License-Identifier: BSD-3-Clause
// What is to be known of the type of a field.
#pragma once

#include <cstddef>
#include <string>
#include <type_traits>

#include "def.hpp"

namespace iksel::python {

/// What Python does with the value of a field: one table of functions per type, so that the code
/// around fields is compiled once and not once for each of them.
struct ValueType {
  std::string argument;   ///< its type in signatures that take one
  std::string attribute;  ///< its type as an attribute
  /// Throws InvalidArgumentError that names the culprit; `dof` is the arm's, or -1.
  void (*set)(void* value, py::handle given, const char* name, int dof);
  /// The value itself where Python can hold it, so that its own attributes can be set.
  py::object (*get)(void* value, py::handle owner);
  /// Plain Python data: enums by name, structs as dicts.
  py::object (*to_plain)(const void* value);
};

template <class T>
const T& as(const void* value) {
  return *static_cast<const T*>(value);
}

template <class Struct>
const Struct& defaults_of() {
  static const Struct defaults{};
  return defaults;
}

/// Of a member in its struct [bytes].
template <class Struct, class T>
std::size_t offset_of(T Struct::*member) {
  const Struct& any = defaults_of<Struct>();
  return static_cast<std::size_t>(reinterpret_cast<const char*>(&(any.*member)) -
                                  reinterpret_cast<const char*>(&any));
}

inline std::string repr_text(py::handle value) { return py::cast<std::string>(py::repr(value)); }

/// Specialised for what is something else as plain data
/// than as an attribute.
template <class T, class Enable = void>
struct ValueOf {
  static py::object to_plain(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return py::str(enum_name(value));
    } else {
      return get(value, {});
    }
  }
  static py::object get(const T& value, py::handle /*owner*/) {
    if constexpr (std::is_enum_v<T> && !HasPythonEnum<T>::value) {
      return to_plain(value);
    } else {
      return to_python(T(value), {});
    }
  }
};

template <class T>
const ValueType& value_type() {
  using V = ValueOf<T>;
  static const ValueType type{
      FromPython<T>::text(),
      type_text<T>(),
      [](void* value, py::handle given, const char* name, int dof) {
        *static_cast<T*>(value) = from_python<T>(given, name, dof);
      },
      [](void* value, py::handle owner) { return V::get(*static_cast<T*>(value), owner); },
      [](const void* value) { return V::to_plain(as<T>(value)); },
  };
  return type;
}

}  // namespace iksel::python
