// SPDX-License-Identifier: BSD-3-Clause
// Joint values by name.
#pragma once

#include <map>
#include <string>

#include "array_checks.hpp"

namespace iksel::python {

using JointValues = std::map<std::string, double>;

inline JointValues as_joint_values(py::handle value, const char* name) {
  if (!py::hasattr(value, "keys")) throw_wrong_type(name, "a mapping of names to numbers", value);
  JointValues joints;
  for (const auto& [key, number] : py::dict(py::reinterpret_borrow<py::object>(value))) {
    if (!py::isinstance<py::str>(key)) throw_wrong_type(name, "joint names as keys", key);
    const std::string joint = as_text(key, name);
    const std::string culprit = std::string(name) + "['" + joint + "']";
    joints[joint] = from_python<double>(number, culprit.c_str());
  }
  return joints;
}

template <>
struct FromPython<JointValues> {
  static std::string text() { return "collections.abc.Mapping[str, float]"; }
  static JointValues convert(py::handle value, const char* name) {
    return as_joint_values(value, name);
  }
};

}  // namespace iksel::python
