// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <new>

#include "bindings.hpp"

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

/// A class for what is thrown as CppError; of void, for what is not thrown.
template <class CppError>
py::object bind_error(py::module_& m, const char* name, const py::handle& bases,
                      const char* doc = nullptr) {
  const std::string full = std::string("iksel_cpp.") + name;
  if (doc == nullptr) doc = header_text(name);
  PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (type == nullptr) throw py::error_already_set();
  m.attr(name) = py::handle(type);
  if constexpr (!std::is_void_v<CppError>) {
    const auto is = [](const std::exception& error) {
      return dynamic_cast<const CppError*>(&error) != nullptr;
    };
    error_classes().insert(error_classes().begin(), {is, type});
  }
  return py::reinterpret_borrow<py::object>(type);
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
  // What is told may be a path, which need not be UTF-8.
  const auto text = py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(error.what(), std::strlen(error.what()), "replace"));
  if (!text) return;
  const auto* names = dynamic_cast<const UrdfError*>(&error);
  if (names == nullptr) {
    PyErr_SetObject(type.ptr(), text.ptr());
    return;
  }
  // Errors about names carry those that there were.
  const py::object object = type(text);
  object.attr("available") = py::tuple(py::cast(names->available()));
  PyErr_SetObject(type.ptr(), object.ptr());
}

void bind_errors(py::module_& m) {
  bind_error<void>(m, "AngleUnitWarning", PyExc_UserWarning,
                   "Angles that look like degrees were given where radians are meant.");
  const auto error = bind_error<Error>(m, "Error", PyExc_Exception);
  const auto urdf = bind_error<UrdfError>(m, "UrdfError", error);
  const auto unknown = bind_error<UnknownNameError>(m, "UnknownNameError", urdf);
  for (const py::object& type : {urdf, unknown}) type.attr("available") = py::tuple();
  const auto invalid = bind_error<InvalidArgumentError>(
      m, "InvalidArgumentError", py::make_tuple(error, py::handle(PyExc_ValueError)));
  bind_error<SignatureError>(
      m, "SignatureError", py::make_tuple(invalid, py::handle(PyExc_TypeError)),
      "A call that does not fit: an unknown keyword, a missing argument, one of another class.");
  const auto database = bind_error<DatabaseError>(m, "DatabaseError", error);
  bind_error<DatabaseIoError>(m, "DatabaseIoError", database);
  bind_error<DatabaseCorruptError>(m, "DatabaseCorruptError", database);
  bind_error<DatabaseMismatchError>(m, "DatabaseMismatchError", database);
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
