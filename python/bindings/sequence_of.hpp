// SPDX-License-Identifier: BSD-3-Clause
// Sequences as arguments.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "python_types.hpp"
#include "results.hpp"

namespace iksel::python {

/// What `read(item, "name[i]")` makes of each item. Throws InvalidArgumentError about what is no
/// sequence, or a str.
template <class Read>
auto read_sequence(py::handle value, const std::string& name, const std::string& expected,
                   const Read& read) {
  if (PySequence_Check(value.ptr()) == 0 || py::isinstance<py::str>(value)) {
    throw_wrong_type(name, expected, value);
  }
  std::vector<Plain<decltype(read(std::declval<const py::object&>(), ""))>> items;
  // Not handles: what is made on the way of an arbitrary sequence has no other owner.
  for (const py::object item : py::reinterpret_borrow<py::sequence>(value)) {
    const std::string at = name + "[" + std::to_string(items.size()) + "]";
    items.push_back(read(item, at.c_str()));
  }
  return items;
}

/// A sequence of objects of a bound class. Throws InvalidArgumentError that names the culprit.
template <class T>
struct FromSequence {
  static std::string text() { return "collections.abc.Sequence[" + type_text<T>() + "]"; }
  static std::vector<T> convert(py::handle value, const char* name) {
    const std::string& type = ClassOf<T>::name;
    return read_sequence(value, name, "a sequence of " + type,
                         [&](const py::object& item, const char* at) {
                           if (!is_a<T>(item)) throw_wrong_type(at, "a " + type, item);
                           return made<T>(item);
                         });
  }
};

}  // namespace iksel::python
