// SPDX-License-Identifier: BSD-3-Clause
// Joint values by name.
#pragma once

#include <map>
#include <string>

#include "array_checks.hpp"

namespace iksel::python {

inline std::map<std::string, double> as_joint_values(const JointValues& value, const char* name) {
  if (!py::hasattr(value, "keys")) throw_wrong_type(name, "a mapping of names to numbers", value);
  std::map<std::string, double> joints;
  for (const auto& [key, number] : py::dict(py::object(value))) {
    if (!py::isinstance<py::str>(key)) throw_wrong_type(name, "joint names as keys", key);
    const std::string joint = as_text(key, name);
    const std::string culprit = std::string(name) + "['" + joint + "']";
    joints[joint] = from_python<double>(number, culprit.c_str());
  }
  return joints;
}

}  // namespace iksel::python
