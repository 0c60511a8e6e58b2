// SPDX-License-Identifier: BSD-3-Clause
// Python callables as iksel::Progress.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/typing.h>

#include <chrono>
#include <cstddef>
#include <optional>

#include "gil.hpp"
#include "iksel/database.hpp"
#include "python_types.hpp"

namespace iksel::python {

namespace py = pybind11;

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
