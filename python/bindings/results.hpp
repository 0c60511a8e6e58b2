// SPDX-License-Identifier: BSD-3-Clause
// What functions and properties of C++ give to Python, and its types in signatures and stubs.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "class.hpp"
#include "enums.hpp"

namespace iksel::python {

template <class T, class Enable = void>
struct FromPython;

/// What Python gets as show(value) of FromPython.
template <class T, class = void>
struct IsShown : std::false_type {};
template <class T>
struct IsShown<T, std::void_t<decltype(FromPython<T>::show(std::declval<const T&>()))>>
    : std::true_type {};

template <class T>
using Plain = std::remove_cv_t<std::remove_reference_t<T>>;

template <class... T>
std::string type_text();

/// A result whose type is said by those derived from it.
struct RawResult : py::object {
  explicit RawResult(py::object value) : py::object(std::move(value)) {}
};

/// (dof,) or None.
struct OptionalArray : RawResult {
  using RawResult::RawResult;
  static constexpr const char* kText = "numpy.typing.NDArray[numpy.float64] | None";
};

struct OptionalIndex : RawResult {
  using RawResult::RawResult;
  static constexpr const char* kText = "int | None";
};

/// A number, or None where it is below 0.
inline OptionalIndex optional_index(std::ptrdiff_t index) {
  return OptionalIndex(index < 0 ? py::object(py::none()) : py::object(py::int_(index)));
}

/// A truth value for one configuration, an array of them for many; the types of arrays do not tell
/// which.
struct BoolOrArray : RawResult {
  using RawResult::RawResult;
  static constexpr const char* kText = "bool | typing.Any";
};

/// "iksel_cpp.Robot", "list[str]"; of more than one type "A, B".
template <class T>
struct ResultType {
  static std::string text() {
    if constexpr (IsShown<T>::value)
      return type_text<decltype(FromPython<T>::show(std::declval<const T&>()))>();
    else if constexpr (std::is_void_v<T>)
      return "None";
    else if constexpr (std::is_same_v<T, bool>)
      return "bool";
    else if constexpr (std::is_integral_v<T>)
      return "int";
    else if constexpr (std::is_floating_point_v<T>)
      return "float";
    else if constexpr (std::is_enum_v<T>)
      return HasPythonEnum<T>::value ? std::string("iksel_cpp.") + EnumTable<T>::kName : "str";
    else if constexpr (std::is_base_of_v<RawResult, T>)
      return T::kText;
    else if constexpr (std::is_same_v<T, py::object>)
      return "object";
    else if constexpr (std::is_same_v<T, py::dict>)
      return "dict[str, object]";
    else if constexpr (std::is_same_v<T, py::bytes>)
      return "bytes";
    else if constexpr (std::is_same_v<T, py::str>)
      return "str";
    else if constexpr (std::is_convertible_v<T, std::string>)
      return "str";
    else
      return "iksel_cpp." + ClassOf<T>::name;
  }
};

template <class... T>
std::string type_text() {
  std::string all;
  ((all += (all.empty() ? "" : ", ") + ResultType<Plain<T>>::text()), ...);
  return all;
}

template <class T, int Flags>
struct ResultType<py::array_t<T, Flags>> {
  static std::string text() {
    const std::string dtype = py::cast<std::string>(py::str(py::dtype::of<T>()));
    return "numpy.typing.NDArray[numpy." + dtype + "]";
  }
};
template <class T>
struct ResultType<std::vector<T>> {
  static std::string text() {
    if constexpr (IsShown<std::vector<T>>::value) {
      return type_text<decltype(FromPython<std::vector<T>>::show({}))>();
    } else {
      return "list[" + type_text<T>() + "]";
    }
  }
};
template <class T>
struct ResultType<std::optional<T>> {
  static std::string text() { return type_text<T>() + " | None"; }
};
template <class K, class T>
struct ResultType<std::map<K, T>> {
  static std::string text() { return "dict[" + type_text<K, T>() + "]"; }
};
template <std::size_t N>
struct ResultType<std::array<double, N>> {
  static std::string text() {
    std::string all = "float";
    for (std::size_t i = 1; i < N; ++i) all += ", float";
    return "tuple[" + all + "]";
  }
};
template <class A, class B>
struct ResultType<std::pair<A, B>> {
  static std::string text() { return "tuple[" + type_text<A, B>() + "]"; }
};
template <class... T>
struct ResultType<std::tuple<T...>> {
  static std::string text() { return "tuple[" + type_text<T...>() + "]"; }
};

/// A part of `owner`, which it keeps alive, or a value.
template <class T>
py::object to_python(T&& value, py::handle owner) {
  if constexpr (IsShown<Plain<T>>::value) {
    return to_python(FromPython<Plain<T>>::show(value), owner);
  } else if constexpr (std::is_base_of_v<py::object, Plain<T>>) {
    return std::forward<T>(value);
  } else if constexpr (std::is_lvalue_reference_v<T>) {
    return py::cast(value, py::return_value_policy::reference_internal, owner);
  } else {
    return py::cast(std::forward<T>(value));
  }
}

}  // namespace iksel::python
