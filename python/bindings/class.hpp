// SPDX-License-Identifier: BSD-3-Clause
// Classes of Python that hold an object of C++. One that Python has made by __new__ alone, or whose
// pickle ended before its state, holds none yet: whoever asks for it is refused, since pybind11
// would hand out memory that nobody has written to.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "enums.hpp"

namespace iksel::python {

namespace py = pybind11;
using py::literals::operator""_a;

/// A call that does not fit: an unknown keyword, a missing argument, one of another class.
class SignatureError : public InvalidArgumentError {
 public:
  using InvalidArgumentError::InvalidArgumentError;
};

/// "'abc' (str)", for messages.
std::string describe(py::handle value);

/// Sets Python's error to that class which stands for the exception's.
void set_error(const std::exception& error);

/// What function() returns; null, with Python's error set, if it throws.
template <class Function>
PyObject* or_error(const Function& function) {
  try {
    return function();
  } catch (py::error_already_set& error) {
    error.restore();
  } catch (const py::builtin_exception& error) {
    error.set_error();
  } catch (const std::exception& error) {
    set_error(error);
  }
  return nullptr;
}

/// A function of the package iksel: of what is only for people to read, and what need not be fast.
inline py::object of_package(const char* module, const char* name) {
  return py::module_::import(module).attr(name);
}

/// What the core's headers say about "Class", "Class.member" or "function".
const char* header_text(const std::string& key);

/// The Python class of T.
template <class T>
struct ClassOf {
  static inline PyTypeObject* type = nullptr;
  static inline std::string name;
  static inline PyObject* place = nullptr;  ///< what puts an object of C++ into one of Python
};

/// Has a class know which of its objects were not made yet. `how` says what makes one, in the place
/// of a constructor; `collect`: Collected<T>::set_up.
py::custom_type_setup guard(const char* how, void (*collect)(PyTypeObject*));

/// Whether there is no object of C++ in what is of such a class.
bool is_unmade(PyObject* self);
void set_made(PyObject* self);
[[noreturn]] void throw_unmade();

/// Specialised for what holds objects of Python, of which its garbage collector has to know.
template <class T>
struct Collected {
  static void set_up(PyTypeObject* /*type*/) {}
};

template <class T>
bool is_a(py::handle value) {
  return PyObject_TypeCheck(value.ptr(), ClassOf<T>::type) != 0;
}

/// The object in a Python object. Throws SignatureError about one of another class.
template <class T>
T& made(py::handle self) {
  if (!is_a<T>(self)) {
    throw SignatureError("self: expected a " + ClassOf<T>::name + ", got " + describe(self));
  }
  if (is_unmade(self.ptr())) throw_unmade();
  return py::cast<T&>(self);
}

/// Puts an object into `self`, unless there is one already.
template <class T>
void construct(py::handle self, T&& value) {
  if (!is_unmade(self.ptr())) return;
  auto held = std::make_unique<T>(std::forward<T>(value));
  py::handle(ClassOf<T>::place)(self, py::capsule(held.get(), [](void* /*object*/) {}));
  held.release();
  set_made(self.ptr());
}

/// Without a constructor, but for `how`; with the header's text, or another.
template <class T>
py::class_<T> bind_class(py::module_& m, const char* name, const char* how = nullptr,
                         const char* doc = nullptr) {
  py::class_<T> cls(m, name, doc == nullptr ? header_text(name) : doc,
                    guard(how, &Collected<T>::set_up));
  ClassOf<T>::type = reinterpret_cast<PyTypeObject*>(cls.ptr());
  ClassOf<T>::name = name;
  // pybind11's constructor is kept apart, behind one that reads arguments as all functions do.
  const py::object before = cls.attr("__init__");
  cls.def(py::init([](const py::capsule& object) { return object.get_pointer<T>(); }));
  ClassOf<T>::place = py::object(cls.attr("__init__")).release().ptr();
  cls.attr("__init__") = before;
  return cls;
}

}  // namespace iksel::python
