// SPDX-License-Identifier: BSD-3-Clause
// The interpreter's lock, what becomes of threads at its end, and Ctrl-C in long work.
//
// Before 3.14, Python ends a thread that asks for the lock while the interpreter ends by
// pthread_exit, which unwinds its stack like an exception that may not be caught: in a destructor,
// or beneath code that catches everything, the process aborts. Such threads wait here instead, as
// from 3.14 on, until the process has ended. The thread that ends the interpreter has the lock all
// the while, and destroys what is left: it must not wait for itself.
#pragma once

#include <cxxabi.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <utility>

#include "python_types.hpp"

namespace iksel::python {

/// Whether this thread has the lock; to be asked at any time, also when there is no Python any
/// more.
inline bool has_lock() {
  return PyGILState_GetThisThreadState() != nullptr && PyGILState_Check() == 1;
}

/// function(), which asks for the lock; does not return if Python ends this thread, or has ended:
/// it would give the thread a state made of what is no more there.
template <typename Function>
auto outlive_python(const Function& function) {
  while (Py_IsInitialized() == 0 && !has_lock()) ::pause();
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

/// Lets others have the lock, unless the interpreter ends: then all others wait.
class GilRelease {
 public:
  GilRelease() : state_(Py_IsInitialized() == 0 ? nullptr : PyEval_SaveThread()) {}
  GilRelease(const GilRelease&) = delete;
  GilRelease& operator=(const GilRelease&) = delete;
  ~GilRelease() {
    if (state_ == nullptr) return;
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

/// Checked by make_progress.
struct ProgressCallable : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "collections.abc.Callable[[int, int], object]";
};

/// Calls `callable(done, total)` if there is one, and lets Ctrl-C end the work in any case. To be
/// called without the GIL; an exception passes through the work to the caller. The callable must
/// outlive the returned function.
inline Progress make_progress(const std::optional<ProgressCallable>& callable) {
  if (callable) check_callable(*callable, "progress");
  return [&callable](std::size_t done, std::size_t total) {
    const GilAcquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (callable) call_python(*callable, done, total);
  };
}

/// Lets Ctrl-C end the work.
inline Progress interruptible() {
  static const std::optional<ProgressCallable> no_callable;
  return make_progress(no_callable);
}

/// Lets Ctrl-C end a loop that runs without the GIL: to be called in each round.
class InterruptCheck {
 public:
  void operator()() {
    // Asking for the time, and for the GIL, costs more than a round.
    constexpr int kRounds = 64;
    if (++rounds_ % kRounds != 0) return;
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(30);
    const GilAcquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  int rounds_ = 0;
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now();
};

}  // namespace iksel::python
