// SPDX-License-Identifier: BSD-3-Clause
// Sequences of bound classes as arguments.
#pragma once

#include <string>
#include <vector>

#include "python_types.hpp"

namespace iksel::python {

/// A sequence of `T`, whose name in Python is `type`. Throws InvalidArgumentError that names the
/// culprit.
template <class T>
std::vector<T> as_sequence_of(const py::handle& value, const std::string& name,
                              const std::string& type) {
  if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value)) {
    throw_wrong_type(name.c_str(), "a sequence of " + type, value);
  }
  std::vector<T> items;
  // Not handles: what is made on the way of an arbitrary sequence has no other owner.
  for (const py::object item : py::reinterpret_borrow<py::sequence>(value)) {
    if (!py::isinstance<T>(item)) {
      const std::string culprit = name + "[" + std::to_string(items.size()) + "]";
      throw_wrong_type(culprit.c_str(), "a " + type, item);
    }
    items.push_back(py::cast<T>(item));
  }
  return items;
}

}  // namespace iksel::python
