// SPDX-License-Identifier: BSD-3-Clause
// What scripts/header_tables.py finds in the core's headers: structs, texts and enums, which become
// Python enums by one table of names each, from which parsing and error messages follow too.
#pragma once

#include <pybind11/native_enum.h>
#include <pybind11/pybind11.h>

#include <string>
#include <string_view>
#include <type_traits>

#include "iksel/iksel.hpp"

namespace iksel::python {

namespace py = pybind11;

template <class E>
struct EnumValue {
  const char* name;
  E value;
  const char* doc;
};

/// For every enum: kName, kDoc, kValues.
template <class E>
struct EnumTable;

/// For every struct: kName, and visit(use), which calls use("Struct.member", &Struct::member) for
/// each, those of its base first.
template <class Struct>
struct Members;

struct HeaderText {
  std::string_view key;  ///< "Class", "Class.member" or "function"
  const char* text;
};

}  // namespace iksel::python

#include "header_tables.hpp"

namespace iksel::python {

/// All names of an enum, for messages: "grid, cvt, random".
template <class E>
std::string enum_names() {
  std::string names;
  for (const auto& entry : EnumTable<E>::kValues) {
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  return names;
}

/// Name of a value; "?" if it is none of the enum's.
template <class E>
const char* enum_name(E value) {
  for (const auto& entry : EnumTable<E>::kValues) {
    if (entry.value == value) return entry.name;
  }
  return "?";
}

/// Without this, str() gives "Status.solved", or a number, by the version of Python.
inline void show_names(const py::object& cls) {
  cls.attr("__str__") =
      py::cpp_function([](const py::object& self) { return py::str(self.attr("name")); },
                       py::name("__str__"), py::is_method(cls));
  cls.attr("__format__") = py::cpp_function(
      [](const py::object& self, const py::str& spec) {
        return py::str(self.attr("name").attr("__format__")(spec));
      },
      py::name("__format__"), py::is_method(cls));
}

/// Whether values are known to Python by an enum, and not by their names only.
template <class E>
struct HasPythonEnum : std::true_type {};
template <>  // `raise` could not be written
struct HasPythonEnum<OnInvalidPose> : std::false_type {};
template <>
struct HasPythonEnum<Obstacle::Shape> : std::false_type {};

/// The Python enum.
template <class E>
py::handle& enum_class() {
  static py::handle cls;
  return cls;
}

template <class E>
void bind_enum(py::module_& m) {
  // Statuses and proofs stand as numbers in batch results, and compare with them.
  constexpr bool kIsColumn = std::is_same_v<E, Status> || std::is_same_v<E, Proof>;
  constexpr const char* kBase = kIsColumn ? "enum.IntEnum" : "enum.Enum";
  py::native_enum<E> binding(m, EnumTable<E>::kName, kBase, EnumTable<E>::kDoc);
  for (const auto& entry : EnumTable<E>::kValues) binding.value(entry.name, entry.value, entry.doc);
  binding.finalize();
  enum_class<E>() = py::object(m.attr(EnumTable<E>::kName)).release();
  show_names(py::reinterpret_borrow<py::object>(enum_class<E>()));
}

/// Makes Python's enums; to come before any function that takes or returns them.
template <class... Enums>
void bind_enums(py::module_& m) {
  (bind_enum<Enums>(m), ...);
}

}  // namespace iksel::python
