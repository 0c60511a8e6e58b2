// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <exception>

#include "bindings.hpp"
#include "iksel/error.hpp"
#include "signature.hpp"

namespace iksel::python {

namespace py = pybind11;

namespace {

template <class CppError>
py::handle bind_error(py::module_& m, const char* name, const py::handle& bases, const char* doc) {
  // The translator of a derived class must be registered after, and so tried before, its base's.
  auto& type = py::register_local_exception<CppError>(m, name, bases);
  type.doc() = doc;
  return type;
}

/// Errors about names carry the names that there were as `available`.
template <class CppError>
void bind_available(py::handle type) {
  static py::handle class_of_error;
  class_of_error = type;
  type.attr("available") = py::tuple();
  py::register_local_exception_translator([](std::exception_ptr raised) {
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const CppError& error) {
      const py::object object = class_of_error(error.what());
      object.attr("available") = py::tuple(py::cast(error.available()));
      PyErr_SetObject(class_of_error.ptr(), object.ptr());
    }
  });
}

/// The category is Python's: nothing is thrown.
void bind_angle_unit_warning(py::module_& m) {
  const auto type = py::reinterpret_steal<py::object>(
      PyErr_NewExceptionWithDoc("iksel_cpp.AngleUnitWarning",
                                "Angles that look like degrees were given where radians are meant.",
                                PyExc_UserWarning, nullptr));
  if (!type) throw py::error_already_set();
  m.attr("AngleUnitWarning") = type;
}

}  // namespace

void bind_errors(py::module_& m) {
  bind_angle_unit_warning(m);
  const auto error =
      bind_error<Error>(m, "Error", PyExc_Exception, "Base of every exception of the library.");
  const auto urdf = bind_error<UrdfError>(
      m, "UrdfError", error,
      "A URDF that cannot be read, parsed or turned into a chain; `available` is a tuple of all "
      "the names there were to choose from, where it is about a name.");
  bind_available<UrdfError>(urdf);
  bind_available<UnknownNameError>(bind_error<UnknownNameError>(
      m, "UnknownNameError", urdf,
      "A link or joint name that the URDF does not have; `available` has those it has."));
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
}

}  // namespace iksel::python
