// SPDX-License-Identifier: BSD-3-Clause
// A Result as Python sees it.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/typing.h>

#include <string>

#include "array_checks.hpp"
#include "enums.hpp"
#include "iksel/result.hpp"

namespace iksel::python {

using OptionalJoints = py::typing::Optional<py::array_t<double>>;

/// A Result whose q becomes an array, which nobody may write to, when it is first asked for.
struct PyResult {
  Result result;
  py::object q;

  OptionalJoints joints() {
    if (!q) {
      q = has_joints(result.status) ? py::object(read_only(to_array(result.q))) : py::none();
    }
    return py::reinterpret_borrow<OptionalJoints>(q);
  }
};

/// Whether it leaves no doubt that there is no answer, or no other.
inline bool is_proven(Proof proof) {
  switch (proof) {
    case Proof::reach:
    case Proof::target:
    case Proof::closed_form:
      return true;
    case Proof::sweep:
    case Proof::none:
    case Proof::answer:
      return false;
  }
  return false;
}

/// "not_converged, proven: closed_form".
inline std::string status_text(Status status, Proof proof) {
  std::string text = enum_name(status);
  if (status != Status::solved && is_proven(proof)) {
    text += std::string(", proven: ") + enum_name(proof);
  }
  return text;
}

/// An iterator over what has __len__ and __getitem__ that takes an int.
inline py::typing::Iterator<PyResult> iterate_rows(const py::object& self) {
  return py::reinterpret_steal<py::typing::Iterator<PyResult>>(PySeqIter_New(self.ptr()));
}

}  // namespace iksel::python
