// SPDX-License-Identifier: BSD-3-Clause
// Arguments that are converted by hand, so that a bad one is named in the error, and the types they
// have in signatures and stubs.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <type_traits>

#include "enums.hpp"
#include "iksel/error.hpp"
#include "iksel/options.hpp"
#include "iksel/solver.hpp"
#include "signature.hpp"

namespace iksel::python {

inline bool is_any_object(PyObject* /*object*/) { return true; }

/// Anything that numpy turns into an array: see array_checks.hpp.
class ArrayLike : public py::object {
  PYBIND11_OBJECT_DEFAULT(ArrayLike, object, is_any_object)
};

/// What `closest` may be: see as_closest.
class ClosestLike : public py::object {
  PYBIND11_OBJECT_DEFAULT(ClosestLike, object, is_any_object)
};

/// A path, or the text or bytes of a URDF.
class UrdfSource : public py::object {
  PYBIND11_OBJECT_DEFAULT(UrdfSource, object, is_any_object)
};

/// A path, or any other text where there is a choice.
class PathLike : public py::object {
  PYBIND11_OBJECT_DEFAULT(PathLike, object, is_any_object)
};

/// Joint names and values.
class JointValues : public py::object {
  PYBIND11_OBJECT_DEFAULT(JointValues, object, is_any_object)
};

/// Something that `from_python<T>` turns into a T.
template <class T>
class Loose : public py::object {
  PYBIND11_OBJECT_DEFAULT(Loose, object, is_any_object)
};

/// "'abc' (str)", for messages.
inline std::string describe(py::handle value) {
  std::string text = py::cast<std::string>(py::repr(value));
  constexpr std::size_t kLongest = 60;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  std::string type = Py_TYPE(value.ptr())->tp_name;
  // Nobody but us knows that module.
  const std::string own = "iksel_cpp.";
  if (type.rfind(own, 0) == 0) type.erase(0, own.size());
  return text + " (" + type + ")";
}

[[noreturn]] inline void throw_wrong_type(const char* name, const std::string& expected,
                                          py::handle got) {
  throw InvalidArgumentError(std::string(name) + ": expected " + expected + ", got " +
                             describe(got));
}

inline void check_callable(py::handle value, const char* name) {
  if (PyCallable_Check(value.ptr()) != 0) return;
  throw SignatureError(std::string(name) + ": expected a callable, got " + describe(value));
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

inline std::filesystem::path as_path(const PathLike& value, const char* name) {
  if (!py::isinstance<py::str>(value) && !py::hasattr(value, "__fspath__")) {
    throw_wrong_type(name, "a path", value);
  }
  return py::cast<std::filesystem::path>(value);
}

/// Converts an argument or option; throws InvalidArgumentError naming it. Specialised for the
/// option structs in fields.hpp.
template <class T, class Enable = void>
struct FromPython;

template <class T>
T from_python(py::handle value, const char* name) {
  return FromPython<T>::convert(value, name);
}

template <>
struct FromPython<bool> {
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
  static std::string convert(py::handle value, const char* name) {
    if (!py::isinstance<py::str>(value)) throw_wrong_type(name, "a str", value);
    return as_text(value, name);
  }
};

template <class T>
struct FromPython<T, std::enable_if_t<std::is_floating_point_v<T>>> {
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
  static T convert(py::handle value, const char* name) {
    if (PyBool_Check(value.ptr()) || PyIndex_Check(value.ptr()) == 0) {
      throw_wrong_type(name, "an int", value);
    }
    py::detail::make_caster<T> caster;
    if (!caster.load(value, /*convert=*/true)) {
      using Limits = std::numeric_limits<T>;
      const std::string range = std::is_unsigned_v<T> ? "of 0 or more"
                                                      : "from " + std::to_string(Limits::min()) +
                                                            " to " + std::to_string(Limits::max());
      throw_wrong_type(name, "an int " + range, value);
    }
    return py::detail::cast_op<T>(caster);
  }
};

/// A bound class; those with fields are taken as mappings too, see fields.hpp.
template <class T>
struct IsBoundClass : std::false_type {};
template <>
struct IsBoundClass<Robot> : std::true_type {
  static constexpr const char* kExpected =
      "a Robot, which iksel.load_robot(name) or Robot.from_urdf(path_or_xml) makes";
};
template <>
struct IsBoundClass<Database> : std::true_type {
  static constexpr const char* kExpected =
      "a Database, which Database.build(robot) or Database.load(path) makes";
};
template <>
struct IsBoundClass<Scene> : std::true_type {
  static constexpr const char* kExpected =
      "a Scene, which Scene(robot, spheres) makes; iksel.spheres makes the spheres";
};
template <>
struct IsBoundClass<Solver> : std::true_type {
  static constexpr const char* kExpected = "a Solver, which Solver(robot) makes";
};

template <class T>
struct FromPython<T, std::enable_if_t<IsBoundClass<T>::value>> {
  static T convert(py::handle value, const char* name) {
    if (!py::isinstance<T>(value)) {
      throw SignatureError(std::string(name) + ": expected " + IsBoundClass<T>::kExpected +
                           ", got " + describe(value));
    }
    return py::cast<T>(value);
  }
};

/// A member of the Python enum, or its name.
template <class T>
struct FromPython<T, std::enable_if_t<std::is_enum_v<T>>> {
  static T convert(py::handle value, const char* name) {
    py::detail::make_caster<T> caster;
    if (caster.load(value, /*convert=*/false)) return py::detail::cast_op<T&>(caster);
    if (py::isinstance<py::str>(value)) {
      const std::string text = as_text(value, name);
      for (const auto& entry : EnumTable<T>::kValues) {
        if (text == entry.name) return entry.value;
      }
    }
    throw_wrong_type(name, "one of " + enum_names<T>(), value);
  }
};

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {

template <>
struct handle_type_name<iksel::python::ArrayLike> {
  static constexpr auto name = const_name("numpy.typing.ArrayLike");
};

template <>
struct handle_type_name<iksel::python::ClosestLike> {
  static constexpr auto name = const_name("bool | numpy.typing.ArrayLike | None");
};

template <>
struct handle_type_name<iksel::python::PathLike> {
  static constexpr auto name = const_name("str | os.PathLike[str]");
};

template <>
struct handle_type_name<iksel::python::UrdfSource> {
  static constexpr auto name = const_name("str | bytes | os.PathLike[str]");
};

template <>
struct handle_type_name<iksel::python::JointValues> {
  static constexpr auto name = const_name("collections.abc.Mapping[str, float]");
};

template <class T>
struct handle_type_name<iksel::python::Loose<T>> {
  static constexpr auto describe() {
    if constexpr (std::is_same_v<T, iksel::OnInvalidPose>) {
      return const_name("typing.Literal['status', 'raise']");
    } else if constexpr (std::is_enum_v<T>) {
      return make_caster<T>::name + const_name(" | str");
    } else if constexpr (std::is_same_v<T, std::string>) {
      return const_name("str");
    } else if constexpr (std::is_same_v<T, std::array<double, 2>> ||
                         std::is_same_v<T, std::array<double, 3>>) {
      return const_name("collections.abc.Sequence[float]");
    } else if constexpr (iksel::python::IsBoundClass<T>::value) {
      return make_caster<T>::name;
    } else if constexpr (std::is_class_v<T>) {
      return make_caster<T>::name + const_name(" | collections.abc.Mapping[str, object]");
    } else if constexpr (std::is_same_v<T, bool>) {
      return const_name("bool");
    } else if constexpr (std::is_integral_v<T>) {
      return const_name("int");
    } else {
      return const_name("float");
    }
  }
  static constexpr auto name = describe();
};

}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)
