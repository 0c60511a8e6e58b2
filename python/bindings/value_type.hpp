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
  /// Whether a signature can show a default.
  bool has_short_repr;
  /// Throws InvalidArgumentError that names the culprit.
  void (*set)(void* value, py::handle given, const char* name);
  /// The value itself where Python can hold it, so that its own attributes can be set.
  py::object (*get)(void* value, py::handle owner);
  /// Plain Python data: enums by name, structs as dicts.
  py::object (*to_plain)(const void* value);
  std::string (*repr)(const void* value);
  bool (*equal)(const void* a, const void* b);
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

/// Specialised for every type of field: kHasShortRepr, get(), to_plain(), repr(), equal(). A value
/// is read by FromPython. A std::variant of structs needs these two and nothing else: what is
/// around fields never asks what they hold.
template <class T, class Enable = void>
struct ValueOf;

template <class T>
const ValueType& value_type() {
  using V = ValueOf<T>;
  static const ValueType type{
      FromPython<T>::text(),
      type_text<T>(),
      V::kHasShortRepr,
      [](void* value, py::handle given, const char* name) {
        *static_cast<T*>(value) = from_python<T>(given, name);
      },
      [](void* value, py::handle owner) { return V::get(*static_cast<T*>(value), owner); },
      [](const void* value) { return V::to_plain(as<T>(value)); },
      [](const void* value) { return V::repr(as<T>(value)); },
      [](const void* a, const void* b) { return V::equal(as<T>(a), as<T>(b)); },
  };
  return type;
}

/// What most types have in common; `Own` has to_plain().
template <class T, class Own>
struct PlainValue {
  static constexpr bool kHasShortRepr = true;
  static py::object get(const T& value, py::handle /*owner*/) { return Own::to_plain(value); }
  static std::string repr(const T& value) { return repr_text(Own::to_plain(value)); }
  static bool equal(const T& a, const T& b) { return a == b; }
};

template <class T>
struct ValueOf<T, std::enable_if_t<std::is_arithmetic_v<T>>> : PlainValue<T, ValueOf<T>> {
  static py::object to_plain(T value) { return py::cast(value); }
};

template <>
struct ValueOf<std::string> : PlainValue<std::string, ValueOf<std::string>> {
  static py::object to_plain(const std::string& value) { return py::str(value); }
};

template <class T>
struct ValueOf<T, std::enable_if_t<std::is_enum_v<T>>> : PlainValue<T, ValueOf<T>> {
  static py::object get(T value, py::handle /*owner*/) { return py::cast(value); }
  static py::object to_plain(T value) { return py::str(enum_name(value)); }
};

/// A tuple, which is a copy, so that nobody takes it for the struct's own.
template <std::size_t N>
struct ValueOf<std::array<double, N>>
    : PlainValue<std::array<double, N>, ValueOf<std::array<double, N>>> {
  static py::object to_plain(const std::array<double, N>& value) {
    py::tuple items(N);
    for (std::size_t i = 0; i < N; ++i) items[i] = value[i];
    return items;
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
