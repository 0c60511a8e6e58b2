// SPDX-License-Identifier: BSD-3-Clause
// The interpreter's lock, and what becomes of threads at its end.
//
// Before 3.14, Python ends a thread that asks for the lock while the interpreter ends by
// pthread_exit, which unwinds its stack like an exception that may not be caught: in a destructor,
// or beneath code that catches everything, the process aborts. Such threads wait here instead, as
// from 3.14 on, until the process has ended.
#pragma once

#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

#include <optional>
#include <utility>

namespace iksel::python {

namespace py = pybind11;

/// function(), which asks for the lock; does not return if Python ends this thread, or has ended:
/// it would give the thread a state made of what is no more there.
template <typename Function>
auto outlive_python(const Function& function) {
  while (Py_IsInitialized() == 0) ::pause();
#ifdef __GLIBCXX__
  try {
    return function();
  } catch (const abi::__forced_unwind&) {
    for (;;) ::pause();
  }
#else
  return function();
#endif
}

/// Lets others have the lock.
class GilRelease {
 public:
  GilRelease() : state_(PyEval_SaveThread()) {}
  GilRelease(const GilRelease&) = delete;
  GilRelease& operator=(const GilRelease&) = delete;
  ~GilRelease() {
    outlive_python([this] { PyEval_RestoreThread(state_); });
  }

 private:
  PyThreadState* state_;
};

/// What function() gives without the lock.
template <typename Function>
auto without_gil(const Function& function) {
  const GilRelease release;
  return function();
}

/// Has the lock, on any thread.
class GilAcquire {
 public:
  GilAcquire() {
    outlive_python([this] { acquired_.emplace(); });
  }

 private:
  std::optional<py::gil_scoped_acquire> acquired_;
};

/// callable(arguments ...) with the lock held. Throws what it raises.
template <typename... Arguments>
py::object call_python(const py::handle& callable, Arguments&&... arguments) {
  const py::tuple packed = py::make_tuple(std::forward<Arguments>(arguments)...);
  PyObject* const result =
      outlive_python([&] { return PyObject_CallObject(callable.ptr(), packed.ptr()); });
  if (result == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(result);
}

}  // namespace iksel::python
