// SPDX-License-Identifier: BSD-3-Clause
#include "class.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <stdexcept>

namespace iksel::python {

namespace {

/// How to come by an object of a class without a constructor.
std::map<PyTypeObject*, const char*>& makers() {
  static std::map<PyTypeObject*, const char*> all;
  return all;
}

/// Where the mark lies in objects: behind what pybind11 has there, which is as long in all classes.
Py_ssize_t mark_offset = 0;

bool& mark_of(PyObject* self) {
  return *reinterpret_cast<bool*>(reinterpret_cast<char*>(self) + mark_offset);
}

/// In the place of pybind11's __new__, which is that of the class below all.
PyObject* make_unmade(PyTypeObject* type, PyObject* arguments, PyObject* keywords) {
  const PyTypeObject* root = type;
  while (root->tp_base != &PyBaseObject_Type) root = root->tp_base;
  PyObject* self = root->tp_new(type, arguments, keywords);
  if (self != nullptr) mark_of(self) = true;
  return self;
}

int refuse_constructor(PyObject* self, PyObject* /*arguments*/, PyObject* /*keywords*/) {
  for (PyTypeObject* type = Py_TYPE(self); type != nullptr; type = type->tp_base) {
    const auto found = makers().find(type);
    if (found == makers().end()) continue;
    const std::string name =
        py::cast<std::string>(py::handle(reinterpret_cast<PyObject*>(type)).attr("__name__"));
    const std::string text = name + " is not made by calling it, but by " + found->second;
    PyErr_SetString(py::module_::import("iksel_cpp").attr("SignatureError").ptr(), text.c_str());
    break;
  }
  return -1;
}

/// repr(), if it ends: that of lists in lists in lists does not.
py::str repr_of(py::handle value) {
  try {
    return py::repr(value);
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_RecursionError)) throw;
    return "...";
  }
}

}  // namespace

std::string describe(py::handle value) {
  constexpr Py_ssize_t kLongest = 60;  // characters
  const py::str whole = repr_of(value);
  const auto start =
      py::reinterpret_steal<py::object>(PyUnicode_Substring(whole.ptr(), 0, kLongest));
  std::string text = py::bytes(start.attr("encode")("utf-8", "backslashreplace"));
  if (PyUnicode_GetLength(whole.ptr()) > kLongest) text += "...";
  std::string type = Py_TYPE(value.ptr())->tp_name;
  // Nobody but us knows that module.
  const std::string own = "iksel_cpp.";
  if (type.rfind(own, 0) == 0) type.erase(0, own.size());
  return text + " (" + type + ")";
}

const char* header_text(const std::string& key) {
  const auto* found =
      std::lower_bound(std::begin(kHeaderTexts), std::end(kHeaderTexts), key,
                       [](const HeaderText& each, const std::string& of) { return each.key < of; });
  if (found == std::end(kHeaderTexts) || found->key != key) {
    throw std::logic_error("no header says what " + key + " is");
  }
  return found->text;
}

py::custom_type_setup guard(const char* how, void (*collect)(PyTypeObject*)) {
  return py::custom_type_setup([how, collect](PyHeapTypeObject* heap_type) {
    PyTypeObject* type = &heap_type->ht_type;
    mark_offset = type->tp_basicsize;
    type->tp_basicsize += static_cast<Py_ssize_t>(sizeof(void*));
    type->tp_new = &make_unmade;
    collect(type);
    if (how == nullptr) return;
    makers()[type] = how;
    type->tp_init = &refuse_constructor;
  });
}

bool is_unmade(PyObject* self) { return mark_of(self); }
void set_made(PyObject* self) { mark_of(self) = false; }

void throw_unmade() {
  throw InvalidArgumentError(
      "this object was never made: its class was called by __new__ alone, or a pickle ended "
      "before the object's state");
}

}  // namespace iksel::python
