// SPDX-License-Identifier: BSD-3-Clause
// Sequences and mappings as arguments.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "python_types.hpp"

namespace iksel::python {

template <class T>
T from_item(py::handle item, const char* name) {
  return from_python<T>(item, name);
}

/// What `read(item, "name[i]")` makes of each item. Throws InvalidArgumentError about what is no
/// sequence, or a str.
template <class T>
std::vector<T> read_sequence(py::handle value, const std::string& name, const std::string& expected,
                             T (*read)(py::handle, const char*) = &from_item<T>) {
  if (PySequence_Check(value.ptr()) == 0 || py::isinstance<py::str>(value)) {
    throw_wrong_type(name, expected, value);
  }
  std::vector<T> items;
  // Not handles: what is made on the way of an arbitrary sequence has no other owner.
  for (const py::object item : py::reinterpret_borrow<py::sequence>(value)) {
    const std::string at = name + "[" + std::to_string(items.size()) + "]";
    items.push_back(read(item, at.c_str()));
  }
  return items;
}

/// A sequence of objects of a bound class, and nothing that stands for one.
template <class T>
struct FromSequence {
  static std::string text() { return "collections.abc.Sequence[" + type_text<T>() + "]"; }
  static T instance(py::handle item, const char* name) {
    if (!is_a<T>(item)) throw_wrong_type(name, "a " + ClassOf<T>::name, item);
    return made<T>(item);
  }
  static std::vector<T> convert(py::handle value, const char* name) {
    return read_sequence<T>(value, name, "a sequence of " + ClassOf<T>::name, &instance);
  }
};

/// Names; a text alone is no list of them.
using Names = std::vector<std::string>;
template <>
struct FromPython<Names> {
  static std::string text() { return "collections.abc.Sequence[str]"; }
  static Names convert(py::handle value, const char* name) {
    return read_sequence<std::string>(value, name, "a list of names");
  }
};

/// What a mapping holds, in messages.
template <class T>
constexpr const char* kItems = "values";
template <>
inline constexpr const char* kItems<double> = "numbers";

/// By names.
template <class T>
struct FromPython<std::map<std::string, T>> {
  static std::string text() {
    return "collections.abc.Mapping[str, " + FromPython<T>::text() + "]";
  }
  static std::map<std::string, T> convert(py::handle value, const char* name) {
    if (!py::hasattr(value, "keys")) {
      throw_wrong_type(name, std::string("a mapping of names to ") + kItems<T>, value);
    }
    std::map<std::string, T> all;
    const py::dict items(py::reinterpret_borrow<py::object>(value));
    for (const auto& [key, item] : copy_of_dict(items, name)) {
      if (!py::isinstance<py::str>(key)) throw_wrong_type(name, "names as keys", key);
      const std::string of = as_text(key, name);
      const std::string culprit = std::string(name) + "['" + of + "']";
      all[of] = from_python<T>(item, culprit.c_str());
    }
    return all;
  }
};

using JointValues = std::map<std::string, double>;

}  // namespace iksel::python
