// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <exception>
#include <new>
#include <vector>

#include "bindings.hpp"
#include "class.hpp"
#include "errors.hpp"
#include "iksel/error.hpp"

namespace iksel::python {

namespace {

struct ErrorClass {
  bool (*is)(const std::exception& error);
  PyObject* type;
};

/// Those derived from others before them.
std::vector<ErrorClass>& error_classes() {
  static std::vector<ErrorClass> all;
  return all;
}

py::object new_class(py::module_& m, const char* name, const py::handle& bases, const char* doc) {
  const std::string full = std::string("iksel_cpp.") + name;
  auto type = py::reinterpret_steal<py::object>(
      PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr));
  if (!type) throw py::error_already_set();
  m.attr(name) = type;
  return type;
}

template <class CppError>
py::object bind_error(py::module_& m, const char* name, const py::handle& bases, const char* doc) {
  py::object type = new_class(m, name, bases, doc);
  auto& all = error_classes();
  all.insert(all.begin(), {[](const std::exception& error) {
                             return dynamic_cast<const CppError*>(&error) != nullptr;
                           },
                           py::object(type).release().ptr()});
  return type;
}

PyObject* class_of(const std::exception& error) {
  for (const ErrorClass& each : error_classes()) {
    if (each.is(error)) return each.type;
  }
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ? PyExc_MemoryError
                                                                : PyExc_RuntimeError;
}

}  // namespace

void set_error(const std::exception& error) {
  const py::handle type = class_of(error);
  const auto* names = dynamic_cast<const UrdfError*>(&error);
  if (names == nullptr) {
    PyErr_SetString(type.ptr(), error.what());
    return;
  }
  // Errors about names carry those that there were.
  const py::object object = type(error.what());
  object.attr("available") = py::tuple(py::cast(names->available()));
  PyErr_SetObject(type.ptr(), object.ptr());
}

void bind_errors(py::module_& m) {
  // The category is Python's: nothing is thrown.
  new_class(m, "AngleUnitWarning", PyExc_UserWarning,
            "Angles that look like degrees were given where radians are meant.");
  const auto error =
      bind_error<Error>(m, "Error", PyExc_Exception, "Base of every exception of the library.");
  const auto urdf = bind_error<UrdfError>(
      m, "UrdfError", error,
      "A URDF that cannot be read, parsed or turned into a chain; `available` is a tuple of all "
      "the names there were to choose from, where it is about a name.");
  const auto unknown = bind_error<UnknownNameError>(
      m, "UnknownNameError", urdf,
      "A link or joint name that the URDF does not have; `available` has those it has.");
  for (const py::object& type : {urdf, unknown}) type.attr("available") = py::tuple();
  const auto invalid = bind_error<InvalidArgumentError>(
      m, "InvalidArgumentError", py::make_tuple(error, py::handle(PyExc_ValueError)),
      "An argument of the wrong type, shape or value: a pose that is not rigid, a non-finite "
      "number, an option out of range.");
  bind_error<SignatureError>(
      m, "SignatureError", py::make_tuple(invalid, py::handle(PyExc_TypeError)),
      "A call that does not fit: an unknown keyword, a missing argument, one of another class.");
  const auto database = bind_error<DatabaseError>(
      m, "DatabaseError", error, "A database that cannot be built, read, written or trusted.");
  bind_error<DatabaseIoError>(m, "DatabaseIoError", database,
                              "A database file that cannot be opened, read or written.");
  bind_error<DatabaseCorruptError>(
      m, "DatabaseCorruptError", database,
      "A database file that is truncated, corrupted, or no database at all.");
  bind_error<DatabaseMismatchError>(
      m, "DatabaseMismatchError", database,
      "An intact database that does not fit: other robot, other format version, other byte order.");
  // For what pybind11 calls: setters of properties.
  py::register_local_exception_translator([](std::exception_ptr raised) {
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const Error& thrown) {
      set_error(thrown);
    }
  });
}

}  // namespace iksel::python
