// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "iksel/error.hpp"

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

}  // namespace

void bind_errors(py::module_& m) {
  const auto error =
      bind_error<Error>(m, "Error", PyExc_Exception, "Base of every exception of the library.");
  const auto urdf = bind_error<UrdfError>(
      m, "UrdfError", error, "A URDF that cannot be read, parsed or turned into a chain.");
  bind_error<UnknownNameError>(m, "UnknownNameError", urdf,
                               "A link or joint name that the URDF does not have.");
  bind_error<InvalidArgumentError>(
      m, "InvalidArgumentError", py::make_tuple(error, py::handle(PyExc_ValueError)),
      "An argument of the wrong type, shape or value: a pose that is not rigid, a non-finite "
      "number, an option out of range.");
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
