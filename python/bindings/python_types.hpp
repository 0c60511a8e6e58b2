// SPDX-License-Identifier: BSD-3-Clause
// Arguments: what functions of C++ take from Python. A bad one is named in the error. And the types
// that arguments and results have in signatures and stubs.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

#include "class.hpp"
#include "results.hpp"

namespace iksel::python {

[[noreturn]] inline void throw_wrong_type(const std::string& name, const std::string& expected,
                                          py::handle got) {
  throw InvalidArgumentError(name + ": expected " + expected + ", got " + describe(got));
}

inline void check_callable(py::handle value, const char* name) {
  if (PyCallable_Check(value.ptr()) != 0) return;
  throw SignatureError(std::string(name) + ": expected a callable, got " + describe(value));
}

/// A dict that nobody else changes while its items are read.
inline py::dict copy_of_dict(py::handle value, const std::string& name) {
  if (!py::isinstance<py::dict>(value)) throw_wrong_type(name, "a dict", value);
  return value.attr("copy")();
}

/// The text of a str. One that holds bytes which are no UTF-8, as Python has them from a command
/// line, is none.
inline std::string as_text(py::handle value, const char* name) {
  Py_ssize_t size = 0;
  const char* text = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (text == nullptr) {
    PyErr_Clear();
    throw_wrong_type(name, "a str in UTF-8", value);
  }
  return {text, static_cast<std::size_t>(size)};
}

inline std::filesystem::path as_path(py::handle value, const char* name) {
  if (!py::isinstance<py::str>(value) && !py::hasattr(value, "__fspath__")) {
    throw_wrong_type(name, "a path", value);
  }
  try {
    return py::cast<std::filesystem::path>(value);
  } catch (const py::cast_error&) {  // a null character, or what __fspath__ gives
    throw_wrong_type(name, "a path", value);
  }
}

/// Specialised for all that is an argument: text() is its type in signatures; convert() throws
/// InvalidArgumentError naming the argument, and may take the number of the arm's joints, -1 where
/// that is not known. With show(), what Python gets for such a value.
template <class T, class Enable>
struct FromPython;

template <class T, class = void>
struct KnowsArm : std::false_type {};
template <class T>
struct KnowsArm<T, std::void_t<decltype(FromPython<T>::convert(py::handle(), "", -1))>>
    : std::true_type {};

template <class T>
decltype(auto) from_python(py::handle value, const char* name, int dof = -1) {
  if constexpr (KnowsArm<T>::value) {
    return FromPython<T>::convert(value, name, dof);
  } else {
    return FromPython<T>::convert(value, name);
  }
}

/// An argument that a function reads by itself; those derived from it say its type.
struct RawArgument : py::handle {
  explicit RawArgument(py::handle value) : py::handle(value) {}
};

template <class T>
struct FromPython<T, std::enable_if_t<std::is_base_of_v<RawArgument, T>>> {
  static std::string text() { return T::kText; }
  static T convert(py::handle value, const char* /*name*/) { return T(value); }
};

template <>
struct FromPython<py::object> {
  static std::string text() { return "object"; }
  static py::object convert(py::handle value, const char* /*name*/) {
    return py::reinterpret_borrow<py::object>(value);
  }
};

/// Anything that numpy turns into an array: see array_checks.hpp.
struct ArrayLike : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "numpy.typing.ArrayLike";
};

/// A path, or any other text where there is a choice.
struct PathLike : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "str | os.PathLike[str]";
};

template <>
struct FromPython<py::bytes> {
  static std::string text() { return "bytes"; }
  static py::bytes convert(py::handle value, const char* name) {
    if (py::isinstance<py::bytes>(value)) return py::reinterpret_borrow<py::bytes>(value);
    throw SignatureError(std::string(name) + ": expected bytes, got " + describe(value));
  }
};

/// A type, or None.
inline std::string or_none(const std::string& type) {
  const std::string none = " | None";
  const bool has_none =
      type.size() > none.size() && type.compare(type.size() - none.size(), none.size(), none) == 0;
  return has_none ? type : type + none;
}

/// What is None is not given.
template <class T>
struct FromPython<std::optional<T>> {
  static std::string text() { return or_none(FromPython<T>::text()); }
  static std::optional<T> convert(py::handle value, const char* name, int dof) {
    if (value.is_none()) return std::nullopt;
    return from_python<T>(value, name, dof);
  }
};

template <>
struct FromPython<bool> {
  static std::string text() { return "bool"; }
  static bool convert(py::handle value, const char* name) {
    if (value.ptr() == Py_True) return true;
    if (value.ptr() == Py_False) return false;
    if (!py::isinstance(value, py::module_::import("numpy").attr("bool_"))) {
      throw_wrong_type(name, "True or False", value);
    }
    return PyObject_IsTrue(value.ptr()) == 1;
  }
};

template <>
struct FromPython<std::string> {
  static std::string text() { return "str"; }
  static std::string convert(py::handle value, const char* name) {
    if (!py::isinstance<py::str>(value)) throw_wrong_type(name, "a str", value);
    return as_text(value, name);
  }
};

template <class T>
struct FromPython<T, std::enable_if_t<std::is_floating_point_v<T>>> {
  static std::string text() { return "float"; }
  static T convert(py::handle value, const char* name) {
    if (PyBool_Check(value.ptr())) throw_wrong_type(name, "a number", value);
    const double number = PyFloat_AsDouble(value.ptr());
    if (number == -1.0 && PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      throw_wrong_type(name, "a number", value);
    }
    return static_cast<T>(number);
  }
};

template <class T>
struct FromPython<T, std::enable_if_t<std::is_integral_v<T>>> {
  using Limits = std::numeric_limits<T>;
  using Widest = std::conditional_t<std::is_unsigned_v<T>, unsigned long long, long long>;

  static std::string text() { return "int"; }
  static T convert(py::handle value, const char* name) {
    if (PyBool_Check(value.ptr()) || PyIndex_Check(value.ptr()) == 0) {
      throw_wrong_type(name, "an int", value);
    }
    const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    Widest wide = 0;
    if constexpr (std::is_unsigned_v<T>) {
      if (number) wide = PyLong_AsUnsignedLongLong(number.ptr());
    } else {
      if (number) wide = PyLong_AsLongLong(number.ptr());
    }
    const bool is_wrong = PyErr_Occurred() != nullptr;
    if (is_wrong) PyErr_Clear();
    if (is_wrong || wide < Widest{Limits::min()} || wide > Widest{Limits::max()}) {
      const bool is_negative = number && number < py::int_(0);
      const std::string range =
          std::is_unsigned_v<T> && is_negative
              ? "of 0 or more"
              : "from " + std::to_string(Limits::min()) + " to " + std::to_string(Limits::max());
      throw_wrong_type(name, "an int " + range, value);
    }
    return static_cast<T>(wide);
  }
};

/// What makes objects of a bound class that is an argument; those with fields are taken as mappings
/// too, see fields.hpp.
template <class T>
constexpr const char* kExpected = nullptr;
template <>
inline constexpr const char* kExpected<Robot> =
    "a Robot, which iksel.load_robot(name) or Robot.from_urdf(path_or_xml) makes";
template <>
inline constexpr const char* kExpected<Database> =
    "a Database, which Database.build(robot) or Database.load(path) makes";
template <>
inline constexpr const char* kExpected<RobotSpheres> = "RobotSpheres, which iksel.spheres makes";
template <>
inline constexpr const char* kExpected<Scene> =
    "a Scene, which Scene(robot, spheres) makes; iksel.spheres makes the spheres";
template <>
inline constexpr const char* kExpected<Solver> = "a Solver, which Solver(robot) makes";

template <class T>
struct FromPython<T, std::enable_if_t<(kExpected<T> != nullptr)>> {
  static std::string text() { return "iksel_cpp." + ClassOf<T>::name; }
  static const T& convert(py::handle value, const char* name) {
    if (is_a<T>(value)) return made<T>(value);
    throw SignatureError(std::string(name) + ": expected " + kExpected<T> + ", got " +
                         describe(value));
  }
};

/// A member of the Python enum, or its name.
template <class T>
struct FromPython<T, std::enable_if_t<std::is_enum_v<T>>> {
  static std::string text() {
    if constexpr (HasPythonEnum<T>::value) {
      return std::string("iksel_cpp.") + EnumTable<T>::kName + " | str";
    } else {
      std::string names;
      for (const auto& each : EnumTable<T>::kValues) {
        names += (names.empty() ? "'" : ", '") + std::string(each.name) + "'";
      }
      return "typing.Literal[" + names + "]";
    }
  }
  static T convert(py::handle value, const char* name) {
    if (py::isinstance<py::str>(value)) {
      const std::string given = as_text(value, name);
      for (const auto& entry : EnumTable<T>::kValues) {
        if (given == entry.name) return entry.value;
      }
    } else if constexpr (HasPythonEnum<T>::value) {
      if (py::isinstance(value, enum_class<T>())) return py::cast<T>(value);
    }
    throw_wrong_type(name, "one of " + enum_names<T>(), value);
  }
};

/// A sequence of N numbers; Python gets a tuple, which is a copy, so that nobody takes it for the
/// struct's own.
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
  static py::tuple show(const std::array<double, N>& value) { return py::tuple(py::cast(value)); }
};

}  // namespace iksel::python
