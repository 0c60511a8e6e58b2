// SPDX-License-Identifier: BSD-3-Clause
// What Python does with the value of a field: one table of functions per type, so that the code
// around fields is compiled once and not once for each of them.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <cstddef>
#include <string>
#include <type_traits>

#include "python_types.hpp"
#include "results.hpp"

namespace iksel::python {

struct ValueType {
  std::string argument;   ///< its type in signatures that take one
  std::string attribute;  ///< its type as an attribute
  /// Throws InvalidArgumentError that names the culprit.
  void (*set)(void* value, py::handle given, const char* name);
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

/// Specialised for what pybind11 knows nothing of. A value is read by FromPython. A std::variant of
/// structs needs these two and nothing else: what is around fields never asks what they hold.
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
    if constexpr (std::is_base_of_v<py::object, T>) {
      return value;
    } else {
      return py::cast(value);
    }
  }
};

/// Of what is the same as an attribute; `Own` has to_plain().
template <class T, class Own>
struct PlainValue {
  static py::object get(const T& value, py::handle /*owner*/) { return Own::to_plain(value); }
};

template <class T>
const ValueType& value_type() {
  using V = ValueOf<T>;
  static const ValueType type{
      FromPython<T>::text(),
      type_text<T>(),
      [](void* value, py::handle given, const char* name) {
        *static_cast<T*>(value) = from_python<T>(given, name);
      },
      [](void* value, py::handle owner) { return V::get(*static_cast<T*>(value), owner); },
      [](const void* value) { return V::to_plain(as<T>(value)); },
  };
  return type;
}

/// A tuple, which is a copy, so that nobody takes it for the struct's own.
template <std::size_t N>
struct ValueOf<std::array<double, N>>
    : PlainValue<std::array<double, N>, ValueOf<std::array<double, N>>> {
  static py::object to_plain(const std::array<double, N>& value) {
    return py::tuple(py::cast(value));
  }
};

/// A sequence of N numbers.
template <std::size_t N>
struct FromPython<std::array<double, N>> {
  static std::string text() { return "collections.abc.Sequence[float]"; }
  static std::array<double, N> convert(py::handle value, const char* name) {
    const std::string expected = std::to_string(N) + " numbers";
    if (!py::isinstance<py::sequence>(value) && !py::hasattr(value, "__array__")) {
      throw_wrong_type(name, expected, value);
    }
    const py::list items(py::reinterpret_borrow<py::object>(value));
    if (items.size() != N) throw_wrong_type(name, expected, value);
    std::array<double, N> out{};
    for (std::size_t i = 0; i < N; ++i) out[i] = from_python<double>(items[i], name);
    return out;
  }
};

}  // namespace iksel::python
